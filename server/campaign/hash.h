// Numbers made from numbers and texts, the same on every machine.
#pragma once

#include <cstdint>
#include <string_view>

namespace stagger::server::campaign {

/// The finaliser of SplitMix64 (Steele, Lea and Flood 2014): numbers that are close end far apart.
constexpr std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// One number from two; not the same when they change places.
constexpr std::uint64_t mixed(std::uint64_t a, std::uint64_t b) { return mixed(mixed(a) ^ b); }

/// FNV-1a over the bytes, its bits mixed. Texts one after the other: give the last one's hash.
constexpr std::uint64_t hash_text(std::string_view text,
                                  std::uint64_t before = 0xcbf29ce484222325ULL) {
  std::uint64_t value = before;
  for (const char c : text) {
    value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  }
  return mixed(value);
}

/// In [0, 1).
constexpr double unit_interval(std::uint64_t bits) {
  return static_cast<double>(bits >> 11U) * 0x1p-53;
}

}  // namespace stagger::server::campaign
