#include "server/http/problem.h"
#include "server/http/routes/body.h"
#include "server/http/routes/routes.h"

namespace stagger::server {

void add_health_routes(Router& router, Services& services) {
  router.add("GET", "/health", [](const HttpRequest&) {
    return json_response({{"status", "ok"}});
  });
  router.add("GET", "/ready", [&](const HttpRequest&) {
    const SessionState state = services.session.state();
    if (!state.error.empty()) throw Problem(503, "the simulation broke down");
    // Paused on purpose is ready; not one tick yet is not.
    if (state.running && state.tick == 0) throw Problem(503, "the simulation has not ticked yet");
    return json_response({{"status", "ready"}});
  });
}

}  // namespace stagger::server
