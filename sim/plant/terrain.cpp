#include "sim/plant/terrain.h"

#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>

namespace stagger::sim {
namespace {

constexpr double pi = std::numbers::pi;
/// How long a platform takes to reach its velocity [s].
constexpr double run_up = 1.0;
constexpr double rounding = 1e-9;  // of limits that are given in other units

void check(const std::string& field, double value, double low, double high, const char* unit) {
  if (value >= low - rounding && value <= high + rounding) return;  // false for a NaN, too
  std::ostringstream text;
  text << field << " is " << value << "; allowed: " << low << " to " << high << unit;
  throw std::invalid_argument(text.str());
}

void check_count(const char* field, std::size_t count) {
  check(std::string("the number of ") + field, static_cast<double>(count), 0.0,
        static_cast<double>(TerrainParameters::most_items), "");
}

/// Mixes all bits of a number into all bits of the result (the finaliser of splitmix64).
std::uint64_t scattered(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

bool contains(const FrictionPatch& patch, const Vec2& place) {
  return place.x() >= patch.low.x() && place.x() <= patch.high.x() && place.y() >= patch.low.y() &&
         place.y() <= patch.high.y();
}

}  // namespace

void validate(const TerrainParameters& terrain) {
  using Limits = TerrainParameters;
  check("friction", terrain.friction, Limits::least_friction, Limits::most_friction, "");
  check_count("patches", terrain.patches.size());
  for (const FrictionPatch& patch : terrain.patches) {
    check("the friction of a patch", patch.friction, Limits::least_friction, Limits::most_friction,
          "");
    for (int axis = 0; axis < 2; ++axis) {
      check("a patch's corner", patch.low[axis], -Limits::most_distance, Limits::most_distance,
            " m");
      check("a patch's corner across", patch.high[axis], patch.low[axis], Limits::most_distance,
            " m");
    }
  }
  check("slope_angle", terrain.slope_angle, 0.0, Limits::most_slope_deg * pi / 180.0, " rad");
  check("uphill_angle", terrain.uphill_angle, -2.0 * pi, 2.0 * pi, " rad");
  check("unevenness", terrain.unevenness, 0.0, Limits::most_unevenness, " m");
  check("the platform's speed", terrain.platform_velocity.norm(), 0.0, Limits::most_platform_speed,
        " m/s");
  check_count("shoves", terrain.shoves.size());
  for (const PlatformShove& shove : terrain.shoves) {
    check("a shove's at_s", shove.at_s, 0.0, 1e6, " s");
    check("a shove's duration_s", shove.duration_s, Limits::least_shove_duration,
          Limits::most_shove_duration, " s");
    check("a shove's displacement", shove.displacement.norm(), 0.0, Limits::most_shove, " m");
  }
}

Terrain::Terrain(const TerrainParameters& parameters, std::uint64_t seed)
    : parameters_(parameters), seed_(seed) {
  validate(parameters);
  if (parameters.kind != TerrainKind::slope) return;
  const double rise = std::sin(parameters.slope_angle);
  normal_ = Vec3(-rise * std::cos(parameters.uphill_angle),
                 -rise * std::sin(parameters.uphill_angle), std::cos(parameters.slope_angle));
}

double Terrain::height(const Vec2& place) const {
  switch (parameters_.kind) {
    case TerrainKind::flat:
    case TerrainKind::platform:
      break;
    case TerrainKind::slope:
      return -normal_.head<2>().dot(place) / normal_.z();
    case TerrainKind::uneven:
      return tile_height(tile_index(place.x()), tile_index(place.y()));
  }
  return 0.0;
}

std::int64_t Terrain::tile_index(double x) { return std::llround(std::floor(x / tile_size + 0.5)); }

double Terrain::tile_height(std::int64_t column, std::int64_t row) const {
  if (column == 0 && row == 0) return 0.0;
  std::uint64_t bits = scattered(seed_);
  bits = scattered(bits ^ static_cast<std::uint64_t>(column));
  bits = scattered(bits ^ static_cast<std::uint64_t>(row));
  return parameters_.unevenness * static_cast<double>(bits >> 11) * 0x1p-53;
}

double Terrain::friction(const Vec2& place, double time) const {
  double friction = parameters_.friction;
  const Vec2 on_ground = place - platform_position(time);
  for (const FrictionPatch& patch : parameters_.patches) {
    if (contains(patch, on_ground)) friction = patch.friction;
  }
  return friction;
}

Vec2 Terrain::platform_position(double time) const {
  if (parameters_.kind != TerrainKind::platform) return Vec2::Zero();
  const double gathering = std::min(time, run_up);
  const double run =
      0.5 * gathering - run_up / (2.0 * pi) * std::sin(pi * gathering / run_up) + time - gathering;
  Vec2 position = run * parameters_.platform_velocity;
  for (const PlatformShove& shove : parameters_.shoves) {
    const double share = std::clamp((time - shove.at_s) / shove.duration_s, 0.0, 1.0);
    position += (share - std::sin(2.0 * pi * share) / (2.0 * pi)) * shove.displacement;
  }
  return position;
}

}  // namespace stagger::sim
