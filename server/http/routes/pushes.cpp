#include <memory>

#include "server/http/idempotency.h"
#include "server/http/problem.h"
#include "server/http/routes/body.h"
#include "server/http/routes/query.h"
#include "server/http/routes/routes.h"
#include "server/json/push_json.h"
#include "server/json/robot_json.h"

namespace stagger::server {
namespace {

std::uint64_t push_id(const HttpRequest& request) {
  const std::string& text = request.parameters.at("id");
  const auto id = whole_number(text);
  if (!id) throw Problem(404, "there is no push \"" + text + "\"");
  return *id;
}

Json resource(const sim::PushRecord& record) {
  return push_record_json(record, sim::Simulation::tick_s);
}

HttpResponse create_push(const HttpRequest& request, Services& services) {
  sim::PushSpec push;
  const auto robot = services.robots.find(services.session.state().robot);
  read_body(request, false, [&](sim::JsonReader& reader) {
    push = read_push(reader);
    if (robot == nullptr) return;
    if (const auto wrong = check_link(push.link, *robot)) reader.refuse("link", *wrong);
  });
  const sim::PushRecord record = services.session.push(push, source_of(request));
  HttpResponse response = json_response(resource(record), 201);
  response.headers.emplace_back("Location", "/api/v1/pushes/" + std::to_string(record.id));
  return response;
}

HttpResponse list_pushes(const HttpRequest& request, Services& services) {
  QueryReader query(request);
  const PageQuery page = read_page(query);
  query.finish();
  // One more than asked for tells whether there is another page.
  auto records = services.session.pushes(page.before, page.limit + 1);
  Json next = nullptr;
  if (records.size() > page.limit) {
    records.pop_back();
    next = std::to_string(records.back().id);
  }
  Json items = Json::array();
  for (const sim::PushRecord& record : records) items.push_back(resource(record));
  return json_response({{"items", std::move(items)}, {"next_cursor", std::move(next)}});
}

}  // namespace

void add_push_routes(Router& router, Services& services) {
  const auto answers = std::make_shared<Idempotency>();
  router.add("POST", "/api/v1/pushes", [&services, answers](const HttpRequest& request) {
    return answers->run(request, [&] { return create_push(request, services); });
  });
  router.add("GET", "/api/v1/pushes",
             [&](const HttpRequest& request) { return list_pushes(request, services); });
  router.add("GET", "/api/v1/pushes/{id}", [&](const HttpRequest& request) {
    return json_response(resource(services.session.find_push(push_id(request))));
  });
  router.add("DELETE", "/api/v1/pushes/{id}", [&](const HttpRequest& request) {
    return json_response(
        resource(services.session.cancel_push(push_id(request), source_of(request))));
  });
}

}  // namespace stagger::server
