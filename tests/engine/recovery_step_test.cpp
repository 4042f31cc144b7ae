// A robot that stands and is pushed over takes steps, and stands again.
#include <gtest/gtest.h>

#include "engine/capturability.h"
#include "tests/engine/point_mass_walk.h"

namespace stagger::engine {
namespace {

using testing::quick;
using testing::Walk;

/// The robot of the full body: reach 0.7 m, step width 0.1 to 0.6 m.
Parameters robot() {
  Parameters p = quick();
  p.max_step_length = 0.7;
  return p;
}

Vec2 towards(int degrees) {
  const double angle = degrees * M_PI / 180.0;
  return {std::cos(angle), std::sin(angle)};
}

/// Has come to rest on both feet, side by side.
bool rests(const Walk& walk) {
  const auto& feet = walk.measurement().feet;
  const Vec2 apart = (feet[0].position - feet[1].position).head<2>();
  return walk.engine().targets().state == WalkingState::idle &&
         !walk.engine().targets().recovering && (walk.com() - walk.middle()).norm() < 2e-3 &&
         walk.velocity().norm() < 2e-3 && (apart - Vec2(0.0, 0.2)).norm() < 0.02;
}

bool survives(const Parameters& parameters, const Vec2& velocity) {
  Walk walk(parameters);
  walk.run(0.5);
  walk.push(velocity);
  walk.run(8.0);
  return rests(walk);
}

TEST(RecoverySteps, Ladder) {
  for (int direction = 0; direction < 360; direction += 15) {
    std::string line;
    for (double v = 0.05; v < 2.0; v += 0.05)
      line += survives(robot(), v * towards(direction)) ? '1' : '.';
    printf("%3d %s\n", direction, line.c_str());
  }
}

}  // namespace
}  // namespace stagger::engine
