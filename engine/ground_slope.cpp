#include "engine/ground_slope.h"

#include <algorithm>

namespace stagger::engine {

void GroundSlope::learn(const Vec3& from, const Vec3& to) {
  // Feet that are nearer to each other than this say little of a slope.
  constexpr double least_distance = 0.1;  // [m]
  const Vec2 way = (to - from).head<2>();
  const double error = to.z() - from.z() - rise(way);
  if (gradient_.isZero(0.0) && std::abs(error) <= tolerance) return;
  gradient_ += rate * error / std::max(way.squaredNorm(), least_distance * least_distance) * way;
  const double size = gradient_.norm();
  if (size > most) gradient_ *= most / size;
}

}  // namespace stagger::engine
