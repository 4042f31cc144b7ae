// Repeatable Gaussian noise: the same seed gives the same numbers with every standard library.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace stagger::sim {

class Noise {
 public:
  explicit Noise(std::uint64_t seed) : engine_(seed) {}
  /// One of many sequences that a seed gives, independent of the others: what one source of noise
  /// draws does not change what another one does.
  Noise(std::uint64_t seed, std::uint64_t stream) : engine_(mixed(mixed(seed) + stream)) {}

  /// One sample of N(0, 1), by Box and Muller.
  double operator()() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    const double angle = 2.0 * std::numbers::pi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

 private:
  /// The finaliser of SplitMix64 (Steele, Lea and Flood 2014): numbers that are close end far
  /// apart.
  static std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
  }

  /// In (0, 1].
  double uniform() { return (static_cast<double>(engine_() >> 11) + 1.0) * 0x1p-53; }

  std::mt19937_64
      engine_;  // its sequence is fixed by the standard, std::normal_distribution's is not
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace stagger::sim
