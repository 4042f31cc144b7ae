#include "server/recording/mcap_cut.h"

#include <algorithm>
#include <utility>

#include "server/json/json.h"
#include "server/recording/recording_file.h"

namespace stagger::server {
namespace {

constexpr std::size_t cut_chunk_bytes = 1 << 20;  // plain: some 0.3 s of whole ticks

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  return text;
}

/// As the request has put it; empty when all is wanted.
std::map<std::string, std::string> values_of(const Selection& selection) {
  std::map<std::string, std::string> values;
  const Selection all;
  if (selection.fields) values["fields"] = joined(*selection.fields);
  if (selection.from_s != all.from_s) values["from"] = to_text(Json(selection.from_s));
  if (selection.to_s != all.to_s) values["to"] = to_text(Json(selection.to_s));
  if (selection.every != all.every) values["every"] = std::to_string(selection.every);
  return values;
}

}  // namespace

McapCut::McapCut(const std::filesystem::path& file, const Selection& selection,
                 sim::JsonErrors& errors)
    : reader_(file),
      window_(file, selection),
      columns_(choose_columns(file, selection, errors).columns),
      writer_([this](std::string_view bytes) { bytes_ += bytes; }) {
  write_beginning(reader_.about(), writer_);
  const auto values = values_of(selection);
  if (!values.empty()) writer_.add_metadata(selection_metadata, values);
}

bool McapCut::next(std::string& out) {
  bool more = true;
  while (more && bytes_.empty()) {
    const auto item = reader_.next();
    if (item) std::visit([this](const auto& some) { write(some); }, *item);
    more = item && !window_.past_end();
  }
  if (!more) {
    close_chunk();
    writer_.finish();
  }
  out += std::exchange(bytes_, {});
  return more;
}

void McapCut::write(const RecordedWorld& world) {
  close_chunk();
  writer_.add_metadata(world_metadata, metadata_of(world));
}

void McapCut::write(const RecordedTick& tick) {
  if (!window_.takes(tick)) return;
  const FrameSelection& selection = selection_of(tick);
  buffer_.clear();
  selection.schema().write(selection.of(tick.frame), buffer_);
  chunk_.add(tick.channel, tick.time_ns, buffer_);
  if (chunk_.size() > cut_chunk_bytes) close_chunk();
}

void McapCut::write(const RecordedText& text) {
  // What a replay needs is always there; as in every recording, at its beginning at the earliest.
  const bool needed = text.is_command || cuts_journal(text);
  if (!needed && !window_.takes(text)) return;
  chunk_.add(text.is_command ? command_channel : event_channel,
             std::max(text.time_ns, window_.begin_ns()), text.text);
  if (chunk_.size() > cut_chunk_bytes) close_chunk();
}

const FrameSelection& McapCut::selection_of(const RecordedTick& tick) {
  const auto known = frames_.find(tick.schema);
  if (known != frames_.end()) return known->second;
  close_chunk();
  const auto [made, added] = frames_.try_emplace(tick.schema, *tick.schema, columns_);
  write_frame_channel(tick.channel, made->second.schema(), writer_);
  return made->second;
}

void McapCut::close_chunk() {
  if (!chunk_.empty()) writer_.add(chunk_.take());
}

}  // namespace stagger::server
