// What the robot walks on. The physics and the fall detector know it; the engine does not.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/types.h"

namespace stagger::sim {

using engine::Vec2;
using engine::Vec3;

enum class TerrainKind : std::uint8_t { flat, slope, uneven, platform };

/// A rectangle of the ground, along the world's axes, that is more slippery or less.
struct FrictionPatch {
  Vec2 low = Vec2::Zero();   ///< corner with the least x and y [m]
  Vec2 high = Vec2::Zero();  ///< the corner across [m]
  double friction = 0.8;     ///< Coulomb coefficient, 0.1 to 0.8
};

/// One fast move of a platform, from rest to rest: its acceleration is one period of a sine wave of
/// 2 pi distance / duration^2 at its greatest.
struct PlatformShove {
  double at_s = 0.0;                 ///< when it begins [s]
  double duration_s = 0.2;           ///< 0.05 to 5 [s]
  Vec2 displacement = Vec2::Zero();  ///< up to 0.5 m
};

/// Each kind reads the fields of its own; friction and patches are of all kinds.
struct TerrainParameters {
  TerrainKind kind = TerrainKind::flat;
  double friction = 0.8;               ///< Coulomb coefficient, 0.1 to 0.8
  std::vector<FrictionPatch> patches;  ///< where two overlap, the last one counts; up to 64

  /// slope: a plane through the origin, on which the robot stands from the start.
  double slope_angle = 0.0;   ///< 0 to 8 degrees [rad]
  double uphill_angle = 0.0;  ///< heading that leads straight up [rad]

  /// uneven: tiles of 0.5 m, each level, at heights spread evenly from 0 to this; the one
  /// under the start is at 0.
  double unevenness = 0.0;  ///< 0 to 0.03 m

  /// platform: level ground that moves. It gathers speed during the first second.
  Vec2 platform_velocity = Vec2::Zero();  ///< up to 0.5 m/s
  std::vector<PlatformShove> shoves;      ///< up to 64

  static constexpr double least_friction = 0.1;
  static constexpr double most_friction = 0.8;
  static constexpr double most_slope_deg = 8.0;
  static constexpr double most_unevenness = 0.03;       // [m]
  static constexpr double most_platform_speed = 0.5;    // [m/s]
  static constexpr double most_shove = 0.5;             // [m]
  static constexpr double least_shove_duration = 0.05;  // [s]
  static constexpr double most_shove_duration = 5.0;    // [s]
  static constexpr double most_distance = 1000.0;       // of a patch from the origin [m]
  static constexpr std::size_t most_items = 64;         // patches, or shoves
};

/// Throws std::invalid_argument that names field, value and allowed range.
void validate(const TerrainParameters& terrain);

/// A terrain as a function of place and time. A tile's height depends on the seed and the tile's
/// place alone, so that tiles may be made in any order.
class Terrain {
 public:
  static constexpr double tile_size = 0.5;  ///< [m]

  /// Throws what validate() throws.
  explicit Terrain(const TerrainParameters& parameters, std::uint64_t seed = 1);

  const TerrainParameters& parameters() const { return parameters_; }
  /// Of the ground at a place [m].
  double height(const Vec2& place) const;
  /// Of the slope, upward; of all else straight up, tiles' edges left aside.
  Vec3 normal() const { return normal_; }
  /// Coulomb coefficient there; patches ride on the platform.
  double friction(const Vec2& place, double time) const;
  /// Of the tile whose middle is at tile_size * (column, row) [m].
  double tile_height(std::int64_t column, std::int64_t row) const;
  /// Column or row of the tiles that this x or y is on.
  static std::int64_t tile_index(double x);
  /// How far the platform has come [m].
  Vec2 platform_position(double time) const;

 private:
  TerrainParameters parameters_;
  std::uint64_t seed_;
  Vec3 normal_ = Vec3::UnitZ();
};

}  // namespace stagger::sim
