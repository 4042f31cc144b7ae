#include "server/http/access.h"
#include "server/http/routes/body.h"
#include "server/http/routes/routes.h"

namespace stagger::server {

void add_ticket_routes(Router& router, Services& services) {
  router.add("POST", "/api/v1/tickets", [&](const HttpRequest& request) {
    expect_no_fields(request);
    const std::string ticket = services.access.issue_ticket(Access::Clock::now());
    return json_response({{"ticket", ticket}, {"expires_in_s", Access::ticket_life.count()}}, 201);
  });
}

}  // namespace stagger::server
