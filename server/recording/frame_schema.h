// The table of channels as a message definition of ROS 1 (with units), and frames as its messages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "server/live/messages.h"
#include "sim/channels.h"

namespace stagger::server {

/// A frame read back: the numbers of every channel, in the table's order.
struct RecordedFrame {
  std::uint64_t tick = 0;
  double time = 0.0;             ///< simulation time [s]
  std::uint64_t state_hash = 0;  ///< after the tick
  std::vector<std::vector<double>> values;
};

/// Channels without components (joints of the pendulum) are left out.
class FrameSchema {
 public:
  explicit FrameSchema(std::vector<sim::Channel> channels);
  /// From channels_text(); such a schema reads, and cannot write. Throws std::runtime_error.
  static FrameSchema parse(const std::string& channels_text);

  const std::vector<sim::Channel>& channels() const { return channels_; }
  /// For the schema's record, encoding "ros1msg".
  std::string definition() const;
  /// The table as JSON, as the stream's hello tells it: names as they are, units, meanings.
  std::string channels_text() const;

  /// Encoding "ros1".
  void write(const FrameMessage& message, std::string& out) const;
  /// A frame that has this table's numbers.
  void write(const RecordedFrame& frame, std::string& out) const;
  /// Throws BadBytes.
  RecordedFrame read(std::string_view data) const;

 private:
  std::vector<sim::Channel> channels_;
  mutable std::vector<double> values_;
};

}  // namespace stagger::server
