#include "server/http/routes/routes.h"

namespace stagger::server {

void add_metrics_routes(Router& router, Services& services) {
  router.add("GET", "/metrics", [&](const HttpRequest&) {
    return HttpResponse{200,
                        "text/plain; version=0.0.4; charset=utf-8",
                        services.metrics.text(),
                        {{"Cache-Control", "no-store"}}};
  });
}

}  // namespace stagger::server
