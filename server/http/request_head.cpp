#include "server/http/request_head.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <system_error>

#include "server/http/message.h"

namespace stagger::server {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view space = " \t\r";
  const std::size_t first = text.find_first_not_of(space);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(space) - first + 1);
}

std::optional<std::size_t> number_of(std::string_view text) {
  std::size_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

}  // namespace

std::optional<std::size_t> body_length(std::string_view head) {
  std::optional<std::size_t> length;
  while (!head.empty()) {
    const std::string_view line = head.substr(0, head.find('\n'));
    head.remove_prefix(std::min(line.size() + 1, head.size()));
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) continue;
    const std::string name = lower(std::string(trimmed(line.substr(0, colon))));
    if (name == "transfer-encoding" || name == "expect") return std::nullopt;
    if (name != "content-length") continue;
    if (length) return std::nullopt;
    length = number_of(trimmed(line.substr(colon + 1)));
    if (!length) return std::nullopt;
  }
  return length.value_or(0);
}

}  // namespace stagger::server
