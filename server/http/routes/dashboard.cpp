#include "server/http/problem.h"
#include "server/http/routes/routes.h"
#include "server/http/static_files.h"

namespace stagger::server {

void add_dashboard_routes(Router& router, Services& services) {
  router.set_fallback(
      [&](const HttpRequest& request) { return dashboard_response(services.web, request.path); });
  // Comes here only without a WebSocket handshake.
  router.add("GET", "/api/v1/stream", [](const HttpRequest&) -> HttpResponse {
    throw Problem(426, "this is a WebSocket; see docs/stream.md")
        .with_header("Upgrade", "websocket");
  });
}

}  // namespace stagger::server
