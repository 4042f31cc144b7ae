#include <array>

#include "server/http/problem.h"
#include "server/http/routes/body.h"
#include "server/http/routes/routes.h"
#include "server/http/static_files.h"
#include "server/json/robot_json.h"

namespace stagger::server {
namespace {

// A robot's folder may hold more than what viewers need.
constexpr std::array served_extensions{".urdf", ".stl", ".dae", ".obj",
                                       ".mtl",  ".png", ".jpg", ".jpeg"};

std::shared_ptr<const sim::Robot> find(const HttpRequest& request, Services& services) {
  const std::string& name = request.parameters.at("name");
  auto robot = services.robots.find(name);
  if (robot == nullptr) throw Problem(404, "there is no robot \"" + name + "\"");
  return robot;
}

HttpResponse file(const HttpRequest& request, Services& services) {
  const auto robot = find(request, services);
  const std::string& path = request.parameters.at("path");
  const auto found = file_below(robot->folder, path);
  const std::string extension = found ? found->extension().string() : "";
  if (std::find(served_extensions.begin(), served_extensions.end(), extension) ==
      served_extensions.end()) {
    throw Problem(404, "robot " + robot->name + " has no file \"" + path + "\"");
  }
  HttpResponse response = file_response(*found);
  response.headers.emplace_back("Cache-Control", "no-cache");
  return response;
}

}  // namespace

void add_robot_routes(Router& router, Services& services) {
  router.add("GET", "/api/v1/robots", [&](const HttpRequest&) {
    Json items = Json::array();
    for (const std::string& name : services.robots.names()) {
      if (const auto robot = services.robots.find(name)) items.push_back(robot_json(*robot));
    }
    return json_response({{"items", std::move(items)}});
  });
  router.add("GET", "/api/v1/robots/{name}", [&](const HttpRequest& request) {
    return json_response(robot_json(*find(request, services)));
  });
  router.add("GET", "/api/v1/robots/{name}/files/{path...}",
             [&](const HttpRequest& request) { return file(request, services); });
}

}  // namespace stagger::server
