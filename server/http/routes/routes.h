// The routes of docs/api.md, a file for each resource.
#pragma once

#include <filesystem>

#include "server/http/router.h"
#include "server/live/frame_hub.h"
#include "server/live/live_session.h"
#include "server/robot_library.h"

namespace stagger::server {

/// What the routes work on. All of it outlives the server.
struct Services {
  LiveSession& session;
  FrameHub& hub;
  RobotLibrary& robots;
  std::filesystem::path web;  ///< the built dashboard
};

void add_simulation_routes(Router& router, Services& services);
void add_walk_routes(Router& router, Services& services);
void add_push_routes(Router& router, Services& services);
void add_robot_routes(Router& router, Services& services);
void add_health_routes(Router& router, Services& services);
void add_dashboard_routes(Router& router, Services& services);

Router make_router(Services& services);

}  // namespace stagger::server
