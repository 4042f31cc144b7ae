// The one table that describes the Frame: CSV headers, schemas, the stream's hello and the
// dashboard's plots are all made from it.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/frame.h"

namespace stagger::sim {

/// One number of a channel.
struct Component {
  std::string name;  ///< "x", "yaw", or the joint's name
  std::string unit;  ///< "m", "rad", "N m", "1" for pure numbers and codes
};

struct Channel {
  std::string name;     ///< e.g. "dcm_reference"
  std::string frame;    ///< "world", "joint" or "" where there is none
  std::string meaning;  ///< one sentence
  std::vector<Component> components;
  std::size_t max_repeat = 1;  ///< lists (polygon, preview) repeat the components up to this often
  /// Appends count * components.size() numbers to out.
  std::function<void(const Frame&, std::vector<double>& out)> read;
};

/// The table for a robot (joint channels carry its joints' names).
std::vector<Channel> make_channels(const std::vector<std::string>& joint_names);

/// The channel of that name, or nullptr.
const Channel* find_channel(std::span<const Channel> channels, const std::string& name);

}  // namespace stagger::sim
