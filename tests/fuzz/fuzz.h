// What the fuzzers share. A target takes any bytes; what the parser is documented to throw is its
// answer, all else a bug.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace stagger::testing {

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace stagger::testing
