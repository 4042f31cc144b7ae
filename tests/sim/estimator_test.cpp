#include "sim/control/estimator.h"

#include <gtest/gtest.h>

#include "tests/engine/call_counts.h"
#include "tests/sim/kasaei.h"
#include "tests/sim/tick.h"

namespace stagger::sim {
namespace {

/// Sensors and estimator over motions that are given.
class Sensed {
 public:
  explicit Sensed(const RobotState& start, const SensorParameters& parameters = {})
      : sensors_(*kasaei(), parameters, 1, dt, gravity, start),
        estimator_(*kasaei(), parameters, dt, gravity, start) {}

  const RobotState& take(const RobotState& truth, const PerFoot<SoleLoad>& loads) {
    estimator_.update(sensors_.read(truth, loads));
    return estimator_.state();
  }
  const Estimator& estimator() const { return estimator_; }

 private:
  Sensors sensors_;
  Estimator estimator_;
};

PerFoot<SoleLoad> weight_on_both(const Vec2& cop) {
  return {SoleLoad{147.0, cop}, SoleLoad{147.0, cop}};
}

TEST(Estimator, StandsStill) {
  const RobotState truth = nominal_state(*kasaei());
  Sensed sensed(truth);
  for (int i = 0; i < 3000; ++i) sensed.take(truth, weight_on_both(Vec2::Zero()));
  const RobotState& state = sensed.estimator().state();
  EXPECT_LT((state.base_position - truth.base_position).norm(), 0.005);
  EXPECT_LT(state.base_velocity.norm(), 0.005);
  EXPECT_LT((state.q - truth.q).cwiseAbs().maxCoeff(), 5e-4);
}

TEST(Estimator, FollowsARobotThatTipsOverItsToes) {
  // All joints stiff, about the front edge of both soles: 0.1 rad there and back.
  const RobotState start = nominal_state(*kasaei());
  const auto poses = body_poses(kasaei()->model, start);
  const Eigen::Isometry3d sole =
      poses[kasaei()->foot_body(engine::Side::left)] * kasaei()->sole_in_body(engine::Side::left);
  const Vec2 edge(0.5 * kasaei()->description.feet[0].sole.length, 0.0);
  const Vec3 pivot = sole * Vec3(edge.x(), 0.0, 0.0);
  Sensed sensed(start);
  for (int i = 0; i < 500; ++i) sensed.take(start, weight_on_both(Vec2::Zero()));
  double worst_velocity = 0.0;
  double worst_lift = 0.0;
  for (int i = 1; i <= 400; ++i) {
    const double phase = 2.0 * M_PI * i * dt / 0.4;
    const double angle = 0.05 * (1.0 - std::cos(phase));
    const Vec3 rate(0.0, 0.05 * 2.0 * M_PI / 0.4 * std::sin(phase), 0.0);
    RobotState truth = start;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, Vec3::UnitY()));
    truth.base_orientation = turn * start.base_orientation;
    truth.base_position = pivot + turn * (start.base_position - pivot);
    truth.base_angular_velocity = rate;
    truth.base_velocity = rate.cross(truth.base_position - pivot);
    const RobotState& state = sensed.take(truth, weight_on_both(edge));
    worst_velocity = std::max(worst_velocity, (state.base_velocity - truth.base_velocity).norm());
    worst_lift = std::max(worst_lift, (state.base_position - truth.base_position).norm());
    EXPECT_LT(state.base_orientation.angularDistance(truth.base_orientation), 0.005);
  }
  EXPECT_LT(worst_velocity, 0.02);
  EXPECT_LT(worst_lift, 0.01);
}

TEST(Estimator, AFootInTheAirHoldsNothing) {
  // The right foot is swung about while the left one stands: the base does not move.
  RobotState truth = nominal_state(*kasaei());
  Sensed sensed(truth);
  const Eigen::Index knee = kasaei()->model.joint_index("right_knee");
  ASSERT_GE(knee, 0);
  const double start = truth.q[knee];
  for (int i = 1; i <= 1000; ++i) {
    truth.q[knee] = start + 0.3 * std::sin(6.0 * i * dt);
    truth.qd[knee] = 1.8 * std::cos(6.0 * i * dt);
    sensed.take(truth, {SoleLoad{294.0, Vec2::Zero()}, SoleLoad{}});
  }
  EXPECT_TRUE(sensed.estimator().filter().stands(0));
  EXPECT_FALSE(sensed.estimator().filter().stands(1));
  EXPECT_LT((sensed.estimator().state().base_position - truth.base_position).norm(), 0.005);
  EXPECT_LT(sensed.estimator().state().base_velocity.norm(), 0.01);
}

#ifdef STAGGER_CALLS_ARE_COUNTED
TEST(Estimator, NeitherTakesMemoryNorThrows) {
  RobotState truth = nominal_state(*kasaei());
  Sensed sensed(truth);
  const testing::CallCounts before = testing::call_counts();
  for (int i = 0; i < 100; ++i) {
    const double load = i % 20 < 10 ? 147.0 : 0.0;
    sensed.take(truth, {SoleLoad{147.0, Vec2::Zero()}, SoleLoad{load, Vec2::Zero()}});
  }
  EXPECT_EQ(testing::call_counts(), before);
}
#endif

}  // namespace
}  // namespace stagger::sim
