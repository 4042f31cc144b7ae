#include "server/http/openapi.h"
#include "server/http/routes/body.h"
#include "server/http/routes/routes.h"
#include "server/http/static_files.h"

namespace stagger::server {

void add_document_routes(Router& router, Services& services) {
  const std::string document = to_text(openapi_document(openapi_pieces(), STAGGER_VERSION));
  router.add("GET", "/openapi.json", [document](const HttpRequest&) {
    return HttpResponse{200, "application/json", document, {{"Cache-Control", "no-cache"}}};
  });
  router.add("GET", "/docs",
             [&](const HttpRequest&) { return dashboard_response(services.web, "/docs.html"); });
}

}  // namespace stagger::server
