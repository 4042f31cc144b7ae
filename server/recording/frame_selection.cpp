#include "server/recording/frame_selection.h"

#include <algorithm>
#include <limits>

namespace stagger::server {

FrameSelection::FrameSelection(const FrameSchema& whole, const std::vector<RecordedColumn>& columns)
    : schema_({}) {
  const auto places = places_in(whole, columns);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (!places[i]) continue;
    const sim::Channel& channel = whole.channels()[*places[i]];
    const auto chosen =
        static_cast<std::size_t>(std::count(places.begin(), places.end(), places[i]));
    const bool as_it_is = chosen == channel.max_repeat * channel.components.size();
    const std::size_t item = as_it_is ? 0 : columns[i].at / channel.components.size();
    auto part = std::find_if(parts_.begin(), parts_.end(), [&](const Part& other) {
      return other.channel == *places[i] && other.item == item;
    });
    if (part == parts_.end()) part = parts_.insert(part, {*places[i], item, as_it_is, {}});
    part->at.push_back(columns[i].at);
  }

  std::vector<sim::Channel> channels;
  for (const Part& part : parts_) {
    sim::Channel channel = whole.channels()[part.channel];
    if (!part.as_it_is) {
      const std::vector<sim::Component> all = std::move(channel.components);
      channel.components.clear();
      for (const std::size_t at : part.at) channel.components.push_back(all[at % all.size()]);
      if (channel.max_repeat > 1) channel.name += "[" + std::to_string(part.item) + "]";
      channel.max_repeat = 1;
    }
    channels.push_back(std::move(channel));
  }
  schema_ = FrameSchema(std::move(channels));
}

RecordedFrame FrameSelection::of(const RecordedFrame& whole) const {
  RecordedFrame frame{whole.tick, whole.time, whole.state_hash, {}};
  for (const Part& part : parts_) {
    const std::vector<double>& all = whole.values[part.channel];
    if (part.as_it_is) {
      frame.values.push_back(all);
      continue;
    }
    std::vector<double>& some = frame.values.emplace_back();
    for (const std::size_t at : part.at) {
      some.push_back(at < all.size() ? all[at] : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return frame;
}

}  // namespace stagger::server
