#include <spdlog/spdlog.h>

#include <array>
#include <set>

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

Json described(const sim::Robot& robot, Services& services) {
  Json json = robot_json(robot);
  json["uploaded"] = services.uploads.is_uploaded(robot.name);
  return json;
}

/// One that cannot be read must not hide the others.
Json list(Services& services) {
  Json items = Json::array();
  for (const std::string& name : services.robots.names()) {
    try {
      const auto robot = services.robots.find(name);
      if (robot != nullptr) items.push_back(described(*robot, services));
    } catch (const std::runtime_error& error) {
      spdlog::warn("robot {}: {}", name, error.what());
    }
  }
  return {{"items", std::move(items)}};
}

RobotUpload read_form(const HttpRequest& request) {
  if (request.form.empty()) {
    throw Problem(415,
                  "send a form (multipart/form-data) with the parts name, urdf, description "
                  "and mesh");
  }
  RobotUpload upload;
  sim::JsonErrors errors;
  std::set<std::string> seen;
  for (const FormPart& part : request.form) {
    if (part.name == "mesh") {
      upload.meshes.emplace_back(part.filename, part.content);
      continue;
    }
    if (!seen.insert(part.name).second) errors.add("/" + part.name, "is given twice");
    if (part.name == "name") {
      upload.name = part.content;
    } else if (part.name == "urdf") {
      upload.urdf = part.content;
    } else if (part.name == "description") {
      upload.description = part.content;
    } else {
      errors.add("/" + part.name.substr(0, 64), "is unknown; known: name, urdf, description, mesh");
    }
  }
  if (upload.urdf.empty()) errors.add("/urdf", "is missing; allowed: the text of a URDF");
  if (!errors.empty()) throw Problem(errors);
  return upload;
}

bool is_check(const HttpRequest& request) {
  bool check = false;
  sim::JsonErrors errors;
  for (const auto& [name, text] : request.query) {
    if (name != "check") {
      errors.add("/" + name, "is unknown; known: check");
    } else if (text != "true" && text != "false") {
      errors.add("/check", "is \"" + text + "\"; allowed: true, false");
    }
    check = text == "true";
  }
  if (!errors.empty()) throw Problem(errors);
  return check;
}

HttpResponse upload(const HttpRequest& request, Services& services) {
  const bool check = is_check(request);
  const RobotUpload robot = read_form(request);
  try {
    if (check) return json_response({{"report", services.uploads.check(robot)}});
    Json report = services.uploads.store(robot);
    const auto stored = services.robots.find(robot.name);
    if (stored == nullptr) throw Problem(409, "the robot was deleted at once");
    HttpResponse response = json_response(
        {{"robot", described(*stored, services)}, {"report", std::move(report)}}, 201);
    response.headers.emplace_back("Location", "/api/v1/robots/" + robot.name);
    return response;
  } catch (const RobotRefused& refusal) {
    sim::JsonErrors errors;
    errors.add("/" + refusal.field, refusal.what());
    throw Problem(errors);
  }
}

HttpResponse remove_robot(const HttpRequest& request, Services& services) {
  expect_no_fields(request);
  const std::string& name = request.parameters.at("name");
  if (services.session.state().robot == name) {
    throw Problem(409, "robot \"" + name + "\" is in the simulation; reset it with another one");
  }
  services.uploads.remove(name);
  return {204, "", "", {}};
}

}  // namespace

void add_robot_routes(Router& router, Services& services) {
  router.add("GET", "/api/v1/robots",
             [&](const HttpRequest&) { return json_response(list(services)); });
  router.add("POST", "/api/v1/robots",
             [&](const HttpRequest& request) { return upload(request, services); });
  router.add("DELETE", "/api/v1/robots/{name}",
             [&](const HttpRequest& request) { return remove_robot(request, services); });
  router.add("GET", "/api/v1/robots/{name}", [&](const HttpRequest& request) {
    return json_response(described(*find(request, services), services));
  });
  router.add("GET", "/api/v1/robots/{name}/files/{path...}",
             [&](const HttpRequest& request) { return file(request, services); });
}

}  // namespace stagger::server
