// What stands behind the question mark: strict, like the bodies.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/http/message.h"
#include "sim/strict_json.h"

namespace stagger::server {

/// Every name that is asked for is known; finish() refuses the others.
class QueryReader {
 public:
  explicit QueryReader(const HttpRequest& request) : request_(request) {}

  std::uint64_t whole_or(const std::string& name, std::uint64_t otherwise, std::uint64_t least,
                         std::uint64_t most);
  std::optional<std::string> one_of(const std::string& name,
                                    const std::vector<std::string>& allowed);
  /// Throws Problem when anything was wrong.
  void finish();

 private:
  std::optional<std::string> text(const std::string& name);

  const HttpRequest& request_;
  std::vector<std::string> known_;
  sim::JsonErrors errors_;
};

/// ?limit&cursor of a list: how many, and below which id.
struct PageQuery {
  std::uint64_t limit = 100;
  std::uint64_t before = ~0ULL;
};

/// limit 1 to 1000, default 100; cursor from next_cursor.
PageQuery read_page(QueryReader& query);

}  // namespace stagger::server
