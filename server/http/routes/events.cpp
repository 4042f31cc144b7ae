#include "server/http/routes/body.h"
#include "server/http/routes/query.h"
#include "server/http/routes/routes.h"

namespace stagger::server {
namespace {

const std::vector<std::string> event_kinds{"step",       "adjustment",     "push_started",
                                           "push_done",  "push_cancelled", "strategies",
                                           "parameters", "fall",           "command"};

Json event_json(const LoggedEvent& logged) {
  const EventMessage& event = *logged.event;
  Json values = Json::object();
  for (const auto& [name, value] : event.values) values[name] = value;
  Json json{{"id", logged.id},    {"tick", event.tick}, {"time_s", event.time},
            {"kind", event.kind}, {"text", event.text}, {"values", std::move(values)}};
  if (!event.source.empty()) json["source"] = event.source;
  return json;
}

}  // namespace

void add_event_routes(Router& router, Services& services) {
  router.add("GET", "/api/v1/events", [&](const HttpRequest& request) {
    QueryReader reader(request);
    const PageQuery page = read_page(reader);
    EventQuery query;
    query.before = page.before;
    query.limit = page.limit + 1;  // the one more tells whether there is another page
    query.kind = reader.one_of("kind", event_kinds);
    query.since_tick = reader.whole_or("since_tick", 0, 0, ~0ULL);
    reader.finish();
    const EventLog& log = services.session.events();
    auto events = log.find(query);
    Json next = nullptr;
    if (events.size() > page.limit) {
      events.pop_back();
      next = std::to_string(events.back().id);
    }
    Json items = Json::array();
    for (const LoggedEvent& event : events) items.push_back(event_json(event));
    return json_response({{"items", std::move(items)},
                          {"next_cursor", std::move(next)},
                          {"forgotten", log.forgotten()}});
  });
}

}  // namespace stagger::server
