#include "sim/state_hash.h"

namespace stagger::sim {

std::string to_hex(std::uint64_t value) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text(16, '0');
  for (std::size_t i = 0; i < 16; ++i) text[15 - i] = digits[(value >> (4 * i)) & 0xfU];
  return text;
}

}  // namespace stagger::sim
