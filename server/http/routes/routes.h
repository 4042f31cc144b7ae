// The routes of docs/api.md, a file for each resource.
#pragma once

#include <filesystem>

#include "server/campaign/campaign_queue.h"
#include "server/http/access.h"
#include "server/http/router.h"
#include "server/http/server_metrics.h"
#include "server/live/frame_hub.h"
#include "server/live/live_session.h"
#include "server/presets/preset_store.h"
#include "server/recording/recorder.h"
#include "server/robot_library.h"
#include "server/robot_uploads.h"

namespace stagger::server {

/// What the routes work on. All of it outlives the server.
struct Services {
  LiveSession& session;
  FrameHub& hub;
  RobotLibrary& robots;
  Access& access;
  RobotUploads& uploads;
  ServerMetrics& metrics;
  std::filesystem::path web;  ///< the built dashboard
  PresetStore& presets;
  Recorder& recorder;
  campaign::CampaignQueue& campaigns;
};

void add_simulation_routes(Router& router, Services& services);
void add_walk_routes(Router& router, Services& services);
void add_parameter_routes(Router& router, Services& services);
void add_preset_routes(Router& router, Services& services);
void add_event_routes(Router& router, Services& services);
void add_push_routes(Router& router, Services& services);
void add_robot_routes(Router& router, Services& services);
void add_recording_routes(Router& router, Services& services);
void add_campaign_routes(Router& router, Services& services);
void add_trial_routes(Router& router, Services& services);
void add_ticket_routes(Router& router, Services& services);
void add_health_routes(Router& router, Services& services);
void add_metrics_routes(Router& router, Services& services);
void add_document_routes(Router& router, Services& services);
void add_dashboard_routes(Router& router, Services& services);

Router make_router(Services& services);

}  // namespace stagger::server
