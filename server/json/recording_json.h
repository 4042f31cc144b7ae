// Recordings, in requests and answers.
#pragma once

#include "server/json/json.h"
#include "server/recording/recorder.h"
#include "sim/strict_json.h"

namespace stagger::server {

/// "2026-01-31T12:00:00.000Z".
std::string iso_8601(double since_1970_s);

Json recording_json(const RecordingInfo& info);
Json disk_use_json(const DiskUse& use);

/// {"when":"now"|"push","before_s","after_s","note","tags","protected"}, all optional.
RecordingRequest read_recording_request(sim::JsonReader& reader);
/// {"note","tags","protected"}, all optional.
RecordingPatch read_recording_patch(sim::JsonReader& reader);

}  // namespace stagger::server
