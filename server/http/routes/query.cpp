#include "server/http/routes/query.h"

#include <algorithm>
#include <limits>

#include "server/http/problem.h"
#include "server/http/routes/body.h"

namespace stagger::server {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::optional<std::string> QueryReader::text(const std::string& name) {
  known_.push_back(name);
  const auto [first, last] = request_.query.equal_range(name);
  if (first == last) return std::nullopt;
  if (std::next(first) != last) errors_.add("/" + name, "is given twice");
  return first->second;
}

std::uint64_t QueryReader::whole_or(const std::string& name, std::uint64_t otherwise,
                                    std::uint64_t least, std::uint64_t most) {
  const auto given = text(name);
  if (!given) return otherwise;
  const auto value = whole_number(*given);
  if (value && *value >= least && *value <= most) return *value;
  errors_.add("/" + name, "is \"" + given->substr(0, 60) + "\"; allowed: " + std::to_string(least) +
                              " to " + std::to_string(most));
  return otherwise;
}

std::optional<std::string> QueryReader::one_of(const std::string& name,
                                               const std::vector<std::string>& allowed) {
  auto given = text(name);
  if (!given || std::find(allowed.begin(), allowed.end(), *given) != allowed.end()) return given;
  errors_.add("/" + name, "is \"" + given->substr(0, 60) + "\"; allowed: " + joined(allowed));
  return std::nullopt;
}

void QueryReader::finish() {
  for (const auto& [name, value] : request_.query) {
    if (std::find(known_.begin(), known_.end(), name) == known_.end()) {
      errors_.add("/" + name.substr(0, 60), "is unknown; known: " + joined(known_));
    }
  }
  if (!errors_.empty()) throw Problem(errors_);
}

PageQuery read_page(QueryReader& query) {
  PageQuery page;
  page.limit = query.whole_or("limit", page.limit, 1, 1000);
  page.before = query.whole_or("cursor", page.before, 0, std::numeric_limits<std::uint64_t>::max());
  return page;
}

}  // namespace stagger::server
