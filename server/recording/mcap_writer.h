// Makes an MCAP (chunked, indexed, with checksums and statistics), record by record, so that
// whatever has been written can be read if the process dies the next moment.
#pragma once

#include <functional>

#include "server/recording/mcap_format.h"

namespace stagger::server {

class McapWriter {
 public:
  /// Where the bytes go, in their order; what it throws comes out of what has been called here.
  using Sink = std::function<void(std::string_view)>;

  explicit McapWriter(Sink sink);
  /// Goes on behind what is in `index`.
  McapWriter(Sink sink, McapIndex index) : sink_(std::move(sink)), index_(std::move(index)) {}

  void add(const McapSchema& schema);
  void add(const McapChannel& channel);
  void add_metadata(const std::string& name, const std::map<std::string, std::string>& values);
  void add(const McapChunk& chunk);
  /// Writes the summary; nothing can be added after it.
  void finish();

  const McapIndex& index() const { return index_; }
  std::uint64_t size() const { return index_.size; }

 private:
  void append(std::string_view bytes);

  Sink sink_;
  McapIndex index_;
};

}  // namespace stagger::server
