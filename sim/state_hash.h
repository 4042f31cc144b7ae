// FNV-1a over the bits of numbers: equal hashes mean that two runs agreed to the last bit.
#pragma once

#include <bit>
#include <cstdint>
#include <string>

namespace stagger::sim {

class StateHash {
 public:
  void mix(std::uint64_t bits) {
    for (int byte = 0; byte < 8; ++byte) {
      value_ = (value_ ^ ((bits >> (8 * byte)) & 0xffU)) * 0x100000001b3ULL;
    }
  }
  void mix(double number) { mix(std::bit_cast<std::uint64_t>(number)); }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// Sixteen hexadecimal digits.
std::string to_hex(std::uint64_t value);

}  // namespace stagger::sim
