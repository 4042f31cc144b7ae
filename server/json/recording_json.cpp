#include "server/json/recording_json.h"

#include <cmath>
#include <cstdio>
#include <ctime>

#include "sim/simulation.h"

namespace stagger::server {
namespace {

using sim::Range;

constexpr double longest_after_s = 86400.0;
constexpr double most_tags = 16;
constexpr std::size_t longest_tag = 64;     // bytes
constexpr std::size_t longest_note = 4096;  // bytes

}  // namespace

std::string iso_8601(double since_1970_s) {
  const auto seconds = static_cast<std::time_t>(since_1970_s);
  std::tm date{};
  gmtime_r(&seconds, &date);
  char text[96];
  std::snprintf(text, sizeof text, "%04d-%02d-%02dT%02d:%02d:%02d.%03dZ", date.tm_year + 1900,
                date.tm_mon + 1, date.tm_mday, date.tm_hour, date.tm_min, date.tm_sec,
                static_cast<int>((since_1970_s - std::floor(since_1970_s)) * 1000.0));
  return text;
}

Json recording_json(const RecordingInfo& info) {
  return {{"id", info.id},
          {"state", name_of(info.state)},
          {"reason", name_of(info.reason)},
          {"created", iso_8601(info.created_s)},
          {"robot", info.robot},
          {"plant", info.plant},
          {"seed", info.seed},
          {"session_id", info.session_id},
          {"version", info.version},
          {"worlds", info.worlds},
          {"ticks", info.ticks},
          {"duration_s", static_cast<double>(info.ticks) * sim::Simulation::tick_s},
          {"lost_ticks", info.lost_ticks},
          {"pushes", info.pushes},
          {"falls", info.falls},
          {"bytes", info.bytes},
          {"error", info.error.empty() ? Json(nullptr) : Json(info.error)},
          {"note", info.note},
          {"tags", info.tags},
          {"protected", info.is_protected}};
}

Json disk_use_json(const DiskUse& use) {
  return {{"used_bytes", use.used_bytes},
          {"quota_bytes", use.quota_bytes},
          {"warning", use.warning.empty() ? Json(nullptr) : Json(use.warning)}};
}

RecordingPatch read_recording_patch(sim::JsonReader& reader) {
  RecordingPatch patch;
  // A note may be emptied again, which other strings may not be.
  if (const auto* note = reader.value("note");
      note != nullptr && note->is_string() && note->get_ref<const std::string&>().empty()) {
    patch.note = "";
  } else {
    patch.note = reader.optional_string("note", longest_note);
  }
  if (reader.value("tags") != nullptr) {
    patch.tags = reader.string_list("tags", Range::between(0, most_tags), longest_tag);
  }
  patch.is_protected = reader.optional_boolean("protected");
  return patch;
}

RecordingRequest read_recording_request(sim::JsonReader& reader) {
  RecordingRequest request;
  request.on_push = reader.one_of_or<bool>("when", false, {{"now", false}, {"push", true}});
  request.before_s = reader.number_or("before_s", request.on_push ? 2.0 : 0.0,
                                      Range::between(0.0, Recorder::flight_s, "s"));
  request.after_s = reader.optional_number("after_s", Range::between(0.0, longest_after_s, "s"));
  if (request.on_push && !request.after_s) request.after_s = 5.0;
  RecordingPatch patch = read_recording_patch(reader);
  request.note = std::move(patch.note).value_or("");
  request.tags = std::move(patch.tags).value_or(std::vector<std::string>());
  request.is_protected = patch.is_protected.value_or(false);
  return request;
}

}  // namespace stagger::server
