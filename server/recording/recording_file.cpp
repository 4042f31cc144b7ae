#include "server/recording/recording_file.h"

#include "server/json/gait_json.h"
#include "server/json/world_json.h"
#include "server/recording/mcap_chunk.h"
#include "server/recording/recording_reader.h"

namespace stagger::server {
namespace {

constexpr std::uint16_t event_schema = 1;
constexpr std::uint16_t command_schema = 2;

constexpr const char* event_definition =
    R"({"title":"stagger.Event","description":"What happened at a tick; docs/stream.md",)"
    R"("type":"object","properties":{"op":{"const":"event"},)"
    R"("tick":{"type":"integer","description":"number of the tick"},)"
    R"("t":{"type":"number","description":"[s] simulation time"},)"
    R"("kind":{"type":"string"},"text":{"type":"string"},"values":{"type":"object"},)"
    R"("source":{"type":"string","description":"of commands: who sent it"}}})";
constexpr const char* command_definition =
    R"({"title":"stagger.Command","description":"What changed the world, before that tick ran",)"
    R"("type":"object","properties":{)"
    R"("tick":{"type":"integer","description":"first tick that it acted on"},)"
    R"("command":{"type":"object","description":"docs/recording.md"}}})";

}  // namespace

std::string command_text(const sim::JournalEntry& entry) {
  return to_text({{"tick", entry.tick}, {"command", command_json(entry.command)}});
}

void write_beginning(const std::map<std::string, std::string>& about, McapWriter& writer) {
  writer.add_metadata(recording_metadata, about);
  writer.add(McapSchema{event_schema, "stagger.Event", "jsonschema", event_definition});
  writer.add(McapSchema{command_schema, "stagger.Command", "jsonschema", command_definition});
  writer.add(McapChannel{event_channel, event_schema, event_topic, "json", {}});
  writer.add(McapChannel{command_channel, command_schema, command_topic, "json", {}});
}

void write_frame_channel(std::uint16_t number, const FrameSchema& schema, McapWriter& writer) {
  // A schema of its own for each table: the same number serves both.
  writer.add(McapSchema{number, "stagger/Frame", "ros1msg", schema.definition()});
  writer.add(
      McapChannel{number, number, frame_topic, "ros1", {{"channels", schema.channels_text()}}});
}

RecordingFile::RecordingFile(const std::filesystem::path& file, const RecordingInfo& info)
    : file_(file, McapFile::Open::make),
      writer_([this](std::string_view bytes) { file_.write(bytes); }) {
  write_beginning({{"id", info.id},
                   {"reason", std::string(name_of(info.reason))},
                   {"created_s", to_text(Json(info.created_s))},
                   {"version", STAGGER_VERSION}},
                  writer_);
}

void RecordingFile::begin_world(const RecorderChunk& chunk, RecordingInfo& info) {
  world_ = chunk.world;
  const SessionInfo& session = *world_->session;
  if (!writer_.index().channels.contains(world_->frame_channel)) {
    write_frame_channel(world_->frame_channel, *world_->schema, writer_);
  }
  RecordedWorld about;
  about.session_id = session.id;
  about.text = to_text(world_json(session.config));
  about.robot_files = world_->robot_files;
  about.version = STAGGER_VERSION;
  about.journal_is_whole = session.journal->complete();
  about.epoch_ns = world_->epoch_ns;
  writer_.add_metadata(world_metadata, metadata_of(about));
  // All that has changed this world before the recording began.
  const auto journal = session.journal->entries();
  McapChunkBuilder before;
  for (std::size_t i = 0; i < chunk.first_command && i < journal.size(); ++i) {
    before.add(command_channel, chunk.data.start_time, command_text(journal[i]));
  }
  if (!before.empty()) writer_.add(before.take());

  info.robot = session.robot;
  info.plant = name_of(session.plant);
  info.seed = session.seed;
  info.session_id = session.id;
  ++info.worlds;
}

void RecordingFile::add(const RecorderChunk& chunk, RecordingInfo& info) {
  if (world_ != chunk.world) begin_world(chunk, info);
  writer_.add(chunk.data);
  info.ticks += chunk.ticks;
  info.lost_ticks += chunk.lost_ticks;
  info.pushes += chunk.pushes;
  info.falls += chunk.falls;
  info.bytes = writer_.size();
}

void RecordingFile::finish(RecordingInfo& info) {
  writer_.finish();
  file_.finish();
  info.bytes = writer_.size();
}

}  // namespace stagger::server
