#include "server/recording/repair.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdlib>

#include "server/json/gait_json.h"
#include "server/recording/mcap_reader.h"
#include "server/recording/mcap_writer.h"
#include "server/recording/recording_reader.h"

namespace stagger::server {
namespace {

namespace fs = std::filesystem;

std::string about(const RecordingReader& reader, const char* name) {
  const auto found = reader.about().find(name);
  return found == reader.about().end() ? "" : found->second;
}

void count_event(const std::string& text, RecordingInfo& info) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return;
  const std::string kind = json.value("kind", "");
  if (kind == "push_started") ++info.pushes;
  if (kind == "fall") ++info.falls;
  if (kind == gap_kind && json.contains("values") && json["values"].is_object()) {
    info.lost_ticks +=
        static_cast<std::uint64_t>(std::clamp(json["values"].value("ticks", 0.0), 0.0, 1e15));
  }
}

void note_world(const RecordedWorld& world, RecordingInfo& info) {
  const WorldSpec spec = world_of(world);
  info.robot = spec.robot;
  info.plant = name_of(spec.config.plant);
  info.seed = spec.config.seed;
  info.session_id = world.session_id;
  ++info.worlds;
}

/// The row for a file that has none, or an out-of-date one.
void repair_one(const fs::path& file, const std::optional<RecordingInfo>& known,
                Catalogue& catalogue) {
  const std::string id = file.stem().string();
  const bool finished = is_finished(file);
  if (finished && known && known->state == RecordingState::done) return;
  // By a server whose catalogue has been lost meanwhile.
  if (FileLock::is_held(file)) return;
  // Only what is a recording of ours is ever changed.
  const RecordingReader ours(file);
  if (!finished) repair_mcap(file);
  RecordingInfo info = summary_of(file);
  info.id = id;
  if (known) {
    info.note = known->note;
    info.tags = known->tags;
    info.is_protected = known->is_protected;
  }
  catalogue.put(info, file);
  spdlog::info("recording {} was {}: {} ticks", id,
               finished ? "not in the catalogue" : "cut off and has been finished", info.ticks);
}

/// A file that was to be a recording and cannot be read: it is told, and may be deleted.
void give_up(RecordingInfo known, const std::string& why, Catalogue& catalogue) {
  known.state = RecordingState::done;
  known.error = why;
  catalogue.update(known);
}

void repair_file(const fs::path& file, const std::optional<RecordingInfo>& known,
                 Catalogue& catalogue) {
  try {
    repair_one(file, known, catalogue);
  } catch (const std::exception& error) {
    if (!fs::exists(file)) return;  // deleted meanwhile
    spdlog::warn("{} is left as it is: {}", file.string(), error.what());
    if (known) give_up(*known, error.what(), catalogue);
  }
}

}  // namespace

RecordingInfo summary_of(const fs::path& file) {
  RecordingReader reader(file);
  RecordingInfo info;
  info.id = file.stem().string();
  info.state = RecordingState::done;
  info.reason = recording_reason_of(about(reader, "reason")).value_or(RecordingReason::manual);
  info.created_s = std::strtod(about(reader, "created_s").c_str(), nullptr);
  info.version = about(reader, "version");
  while (const auto item = reader.next()) {
    if (const auto* world = std::get_if<RecordedWorld>(&*item)) {
      note_world(*world, info);
    } else if (const auto* text = std::get_if<RecordedText>(&*item)) {
      if (!text->is_command) count_event(text->text, info);
    } else {
      ++info.ticks;
    }
  }
  info.bytes = fs::file_size(file);
  return info;
}

void repair_recording(const fs::path& file, Catalogue& catalogue) {
  const std::string id = file.stem().string();
  if (fs::exists(file)) {
    repair_file(file, catalogue.find(id), catalogue);
  } else {
    catalogue.remove(id);
  }
}

void repair_recordings(const fs::path& folder, const Presence& presence, Catalogue& catalogue) {
  const auto is_under_way = [&presence](const RecordingInfo& info) {
    return info.state != RecordingState::done && presence.is_another(info.owner);
  };
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".mcap" || !entry.is_regular_file()) continue;
    const auto known = catalogue.find(entry.path().stem().string());
    if (known && is_under_way(*known)) continue;
    repair_file(entry.path(), known, catalogue);
  }
  CatalogueQuery all;
  all.limit = ~0U;
  for (const RecordingInfo& info : catalogue.list(all)) {
    // Looked for only now: another server may have begun it meanwhile.
    if (!is_under_way(info) && !fs::exists(folder / (info.id + ".mcap"))) catalogue.remove(info.id);
  }
}

}  // namespace stagger::server
