#include <charconv>
#include <limits>

#include "server/http/problem.h"
#include "server/http/routes/body.h"
#include "server/http/routes/routes.h"
#include "server/json/push_json.h"
#include "server/json/robot_json.h"

namespace stagger::server {
namespace {

constexpr std::uint64_t max_limit = 1000;
constexpr std::uint64_t default_limit = 100;

std::optional<std::uint64_t> whole_number(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::uint64_t push_id(const HttpRequest& request) {
  const std::string& text = request.parameters.at("id");
  const auto id = whole_number(text);
  if (!id) throw Problem(404, "there is no push \"" + text + "\"");
  return *id;
}

Json resource(const sim::PushRecord& record) {
  return push_record_json(record, sim::Simulation::tick_s);
}

HttpResponse create(const HttpRequest& request, Services& services) {
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

struct Page {
  std::uint64_t limit = default_limit;
  std::uint64_t before = std::numeric_limits<std::uint64_t>::max();
};

Page read_page(const HttpRequest& request) {
  Page page;
  sim::JsonErrors errors;
  for (const auto& [name, text] : request.query) {
    const auto value = whole_number(text);
    if (name == "limit") {
      if (!value || *value < 1 || *value > max_limit) {
        errors.add("/limit", "is \"" + text + "\"; allowed: 1 to " + std::to_string(max_limit));
      }
      page.limit = value.value_or(default_limit);
    } else if (name == "cursor") {
      if (!value) errors.add("/cursor", "is \"" + text + "\"; take it from next_cursor");
      page.before = value.value_or(0);
    } else {
      errors.add("/" + name, "is unknown; known: limit, cursor");
    }
  }
  if (!errors.empty()) throw Problem(errors);
  return page;
}

HttpResponse list(const HttpRequest& request, Services& services) {
  const Page page = read_page(request);
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
  router.add("POST", "/api/v1/pushes",
             [&](const HttpRequest& request) { return create(request, services); });
  router.add("GET", "/api/v1/pushes",
             [&](const HttpRequest& request) { return list(request, services); });
  router.add("GET", "/api/v1/pushes/{id}", [&](const HttpRequest& request) {
    return json_response(resource(services.session.find_push(push_id(request))));
  });
  router.add("DELETE", "/api/v1/pushes/{id}", [&](const HttpRequest& request) {
    return json_response(
        resource(services.session.cancel_push(push_id(request), source_of(request))));
  });
}

}  // namespace stagger::server
