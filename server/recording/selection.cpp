#include "server/recording/selection.h"

#include <algorithm>
#include <set>

namespace stagger::server {
namespace {

constexpr const char* hash_field = "state_hash";
constexpr double longest_s = 1e9;  // no recording goes on for 30 years

/// The tables of channels of all the recording's worlds.
std::vector<FrameSchema> schemas_of(const std::filesystem::path& file) {
  std::vector<FrameSchema> schemas;
  McapReader reader(file);
  while (const auto record = reader.next(false)) {
    if (record->op != McapOp::channel) continue;
    const McapChannel channel = read_channel(record->content);
    if (channel.topic != frame_topic) continue;
    const auto table = channel.metadata.find("channels");
    if (table != channel.metadata.end()) schemas.push_back(FrameSchema::parse(table->second));
  }
  return schemas;
}

std::vector<RecordedColumn> all_columns(const std::filesystem::path& file) {
  std::vector<RecordedColumn> all;
  std::set<std::string> labels;
  for (const FrameSchema& schema : schemas_of(file)) {
    for (const sim::Channel& channel : schema.channels()) {
      for (RecordedColumn& column : columns_of(channel)) {
        if (labels.insert(column.label).second) all.push_back(std::move(column));
      }
    }
  }
  return all;
}

std::optional<std::uint64_t> first_tick_ns(const std::filesystem::path& file) {
  RecordingReader reader(file);
  while (const auto item = reader.next()) {
    if (const auto* tick = std::get_if<RecordedTick>(&*item)) return tick->time_ns;
  }
  return std::nullopt;
}

}  // namespace

std::vector<RecordedColumn> columns_of(const sim::Channel& channel) {
  std::vector<RecordedColumn> columns;
  for (std::size_t item = 0; item < channel.max_repeat; ++item) {
    const std::string name =
        channel.max_repeat > 1 ? channel.name + "[" + std::to_string(item) + "]" : channel.name;
    for (const sim::Component& component : channel.components) {
      const bool scalar = channel.components.size() == 1 && component.name == "value";
      columns.push_back({scalar ? name : name + "." + component.name, component.unit, channel.name,
                         columns.size()});
    }
  }
  return columns;
}

ChosenColumns choose_columns(const std::filesystem::path& file, const Selection& selection,
                             sim::JsonErrors& errors) {
  std::vector<RecordedColumn> all = all_columns(file);
  if (!selection.fields) return {std::move(all), true};
  ChosenColumns chosen;
  chosen.with_hash = false;
  std::set<std::string> labels;
  for (const std::string& field : *selection.fields) {
    if (field == hash_field) {
      chosen.with_hash = true;
      continue;
    }
    bool known = false;
    for (const RecordedColumn& column : all) {
      if (column.channel != field && column.label != field) continue;
      known = true;
      if (labels.insert(column.label).second) chosen.columns.push_back(column);
    }
    if (!known) {
      errors.add("/fields", "names \"" + field +
                                "\", which is no channel (com) nor a number of one (com.x) of this "
                                "recording");
    }
  }
  return chosen;
}

std::vector<std::optional<std::size_t>> places_in(const FrameSchema& schema,
                                                  const std::vector<RecordedColumn>& columns) {
  std::vector<std::optional<std::size_t>> places;
  const auto& channels = schema.channels();
  for (const RecordedColumn& column : columns) {
    auto& place = places.emplace_back();
    const auto found =
        std::find_if(channels.begin(), channels.end(),
                     [&column](const auto& channel) { return channel.name == column.channel; });
    if (found == channels.end()) continue;
    const auto own = columns_of(*found);
    if (column.at < own.size() && own[column.at].label == column.label) {
      place = found - channels.begin();
    }
  }
  return places;
}

SelectionWindow::SelectionWindow(const std::filesystem::path& file, const Selection& selection)
    : from_s_(selection.from_s),
      to_s_(selection.to_s),
      every_(selection.every),
      first_ns_(first_tick_ns(file)) {}

double SelectionWindow::elapsed(std::uint64_t time_ns) const {
  if (!first_ns_ || time_ns <= *first_ns_) return 0.0;
  return static_cast<double>(time_ns - *first_ns_) / ns_per_s;
}

bool SelectionWindow::takes(const RecordedTick& tick) {
  const double at = elapsed(tick.time_ns);
  if (at > to_s_) past_end_ = true;
  return at >= from_s_ && !past_end_ && count_++ % every_ == 0;
}

bool SelectionWindow::takes(const RecordedText& event) const {
  const double at = elapsed(event.time_ns);
  return at >= from_s_ && at <= to_s_;
}

std::uint64_t SelectionWindow::begin_ns() const {
  if (!first_ns_ || from_s_ <= 0.0) return 0;
  return *first_ns_ + static_cast<std::uint64_t>(std::min(from_s_, longest_s) * ns_per_s);
}

}  // namespace stagger::server
