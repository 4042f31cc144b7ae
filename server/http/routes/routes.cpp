#include "server/http/routes/routes.h"

namespace stagger::server {

Router make_router(Services& services) {
  Router router;
  add_simulation_routes(router, services);
  add_walk_routes(router, services);
  add_parameter_routes(router, services);
  add_preset_routes(router, services);
  add_event_routes(router, services);
  add_push_routes(router, services);
  add_robot_routes(router, services);
  add_recording_routes(router, services);
  add_campaign_routes(router, services);
  add_trial_routes(router, services);
  add_ticket_routes(router, services);
  add_health_routes(router, services);
  add_metrics_routes(router, services);
  add_document_routes(router, services);
  add_dashboard_routes(router, services);
  return router;
}

}  // namespace stagger::server
