// Frames with some of their numbers, and the table of channels that describes these.
#pragma once

#include "server/recording/selection.h"

namespace stagger::server {

class FrameSelection {
 public:
  /// Of `whole`, the columns that it has. Numbers of one channel stay together, where the first of
  /// them stood. A list of which not everything is chosen becomes a channel for each item, named
  /// as it was called: "preview[0]".
  FrameSelection(const FrameSchema& whole, const std::vector<RecordedColumn>& columns);

  const FrameSchema& schema() const { return schema_; }
  /// As schema() has it; NaN where a list is too short to have the item.
  RecordedFrame of(const RecordedFrame& whole) const;

 private:
  /// What one channel of schema() is made of.
  struct Part {
    std::size_t channel = 0;      ///< of the whole table
    std::size_t item = 0;         ///< of a list
    bool as_it_is = false;        ///< all of it
    std::vector<std::size_t> at;  ///< among the channel's values, unless as it is
  };

  std::vector<Part> parts_;
  FrameSchema schema_;
};

}  // namespace stagger::server
