// A robot's own controller around the walking engine: walk, take a push, stop, and see whether it
// is still up. The robot is a point mass here; yours has joints where this one has integrate().
//   controller [impulse of the push to the left, N s]
#include <engine/walking_engine.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

using namespace stagger::engine;

namespace {

class Robot {
 public:
  explicit Robot(const Parameters& p) : p_(p) {
    state_.com.z() = p.com_height;
    for (const Side side : {Side::left, Side::right}) {
      const double y = lateral_sign(side) * 0.5 * p.stance_width;
      state_.feet[index(side)].position = {0.0, y, 0.0};
      state_.foot_load[index(side)] = 0.5 * p.mass * p.gravity;
    }
  }

  /// On a robot: what the state estimator says.
  const Measurement& measure() const { return state_; }

  /// On a robot: whole-body control. Here the feet go where they are told, and the ground pushes
  /// the mass away from the zero moment point: c'' = g / z_c (c - p) + F / m.
  void act(const WalkingTargets& targets, const Vec2& force) {
    for (const Side side : {Side::left, Side::right}) {
      const FootTarget& target = targets.feet[index(side)];
      FootPose& foot = state_.feet[index(side)];
      if (!target.in_contact) foot = {target.position, target.yaw};
      const bool touches = foot.position.z() <= 0.0;
      state_.foot_load[index(side)] = touches ? 0.5 * p_.mass * p_.gravity : 0.0;
    }
    state_.zmp = targets.zmp_command;
    integrate(p_.gravity / p_.com_height * (state_.com.head<2>() - state_.zmp) + force / p_.mass);
  }

  /// Of the centre of mass from the middle of the feet [m].
  double distance() const {
    const Vec3 middle = 0.5 * (state_.feet[0].position + state_.feet[1].position);
    return (state_.com - middle).head<2>().norm();
  }

 private:
  void integrate(const Vec2& acceleration) {
    state_.com_velocity.head<2>() += p_.tick * acceleration;
    state_.com.head<2>() += p_.tick * state_.com_velocity.head<2>();
  }

  Parameters p_;
  Measurement state_;
};

}  // namespace

int main(int argc, char** argv) {
  const double impulse = argc > 1 ? std::atof(argv[1]) : 10.0;
  Parameters p;  // the rest: 30 kg, centre of mass at 1 m
  p.tick = 0.002;
  p.t_ss = 0.4;
  p.t_ds = 0.1;
  p.measurement_noise = 1e-8;  // the point mass knows its own state well

  Robot robot(p);
  WalkingEngine engine(p, robot.measure());
  engine.walk({0.2, 0.0, 0.0});

  constexpr double push_duration = 0.05;
  double farthest = 0.0;
  for (int i = 0; i * p.tick < 12.0; ++i) {
    const double time = i * p.tick;
    if (i == std::lround(8.0 / p.tick)) engine.stop();
    const bool pushed = time >= 4.0 && time < 4.0 + push_duration;
    const WalkingTargets& targets = engine.update(robot.measure());
    robot.act(targets, pushed ? Vec2(0.0, impulse / push_duration) : Vec2(0.0, 0.0));
    farthest = std::max(farthest, robot.distance());
  }

  const Measurement& end = robot.measure();
  const bool rests = engine.targets().state == WalkingState::idle && robot.distance() < 0.01 &&
                     end.com_velocity.norm() < 0.01 && end.foot_load[0] > 0.0 &&
                     end.foot_load[1] > 0.0;
  // Written so that a value that is not a number is a fall.
  const bool up = farthest < 0.5 && rests;
  std::printf("%s after %llu steps and %.2f m, pushed with %g N s\n", up ? "rests" : "fell",
              static_cast<unsigned long long>(engine.targets().step_count), end.com.x(), impulse);
  return up ? EXIT_SUCCESS : EXIT_FAILURE;
}
