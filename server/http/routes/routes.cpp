#include "server/http/routes/routes.h"

namespace stagger::server {

Router make_router(Services& services) {
  Router router;
  add_simulation_routes(router, services);
  add_walk_routes(router, services);
  add_push_routes(router, services);
  add_robot_routes(router, services);
  add_health_routes(router, services);
  add_dashboard_routes(router, services);
  return router;
}

}  // namespace stagger::server
