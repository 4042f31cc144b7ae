#include "engine/lqg.h"

#include <gtest/gtest.h>

#include "engine/support_polygon.h"

namespace stagger::engine {
namespace {

FootPose foot_at(double x, double y) { return {Vec3(x, y, 0.0), 0.0}; }

// Expected gains: computed with another solver (SciPy's) for the same weights, 500 Hz, CoM at 1 m.
TEST(Lqg, FeedbackGainOfTheRecommendedWeights) {
  const Lqg lqg{Parameters()};
  const Eigen::RowVector3d expected(-0.10982, -4.30495, -0.31195);
  EXPECT_LT((lqg.feedback_gain() - expected).cwiseAbs().maxCoeff(), 1e-5);
}

// Expected gains: the same other solver's, for CoM and DCM alone.
TEST(Lqg, NoWeightOnTheIntegralMeansNoIntegrator) {
  Parameters parameters;
  parameters.lqr_state_weight = {1.0, 10.0, 0.0};
  parameters.lqr_zmp_weight = 1.0;
  const Lqg lqg{parameters};
  const Eigen::RowVector3d expected(-0.1116, -4.3057, 0.0);
  EXPECT_LT((lqg.feedback_gain() - expected).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_EQ(lqg.feedback_gain()(2), 0.0);

  // The same on a loop: the gain moves the DCM back into the middle.
  Lqg controller{parameters};
  const DiscreteLipm plant = discretise(natural_frequency(parameters), parameters.tick);
  const ConvexPolygon polygon = support_polygon(Sole{0.075, 0.0375}, foot_at(0.0, 0.0));
  Eigen::Matrix2d state;
  state << 0.0, 0.0, 0.03, 0.0;
  for (int i = 0; i < 5000; ++i) {
    controller.estimate(state.row(0), state.row(1));
    const Vec2 zmp = controller.control({}, polygon, {}, true, true);
    state = (plant.a * state + plant.b * zmp.transpose()).eval();
  }
  EXPECT_LT(state.cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Lqg, EstimatorGainOfTheQuietSetting) {
  Parameters parameters;
  parameters.process_noise = 1e-8;
  const Lqg lqg{parameters};
  Eigen::Matrix2d expected;
  expected << 0.00334, 0.00484, 0.00484, 0.01178;
  EXPECT_LT((lqg.estimator_gain() - expected).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Lqg, StaysInsideThePolygonAndKeepsTheIntegralThere) {
  const Parameters parameters;
  Lqg lqg(parameters);
  const Sole sole{parameters.foot_half_length, parameters.foot_half_width};
  const ConvexPolygon polygon = support_polygon(sole, foot_at(0.0, 0.0));
  for (int i = 0; i < 500; ++i) {
    lqg.estimate({0.0, 0.0}, {0.5, -0.3});
    const Vec2 zmp = lqg.control({}, polygon, {}, true, true);
    ASSERT_GE(polygon.margin(zmp), -1e-12);
  }
  // Once the error is gone the controller must not owe anything to the time it was saturated.
  lqg.estimate({0.0, 0.0}, {0.0, 0.0});
  for (int i = 0; i < 2000; ++i) {
    lqg.estimate({0.0, 0.0}, {0.0, 0.0});
    lqg.control({}, polygon, {}, true, true);
  }
  EXPECT_LT(lqg.dcm().norm(), 1e-3);
}

TEST(Lqg, RemovesAConstantDisturbance) {
  Parameters parameters;
  parameters.process_noise = 1e-6;
  parameters.measurement_noise = 1e-8;
  Lqg lqg(parameters);
  const double omega = natural_frequency(parameters);
  const DiscreteLipm plant = discretise(omega, parameters.tick);
  const ConvexPolygon polygon = support_polygon(Sole{0.075, 0.0375}, foot_at(0.0, 0.0));
  const Vec2 bias(0.01, 0.0);  // the foot's ZMP sensor or actuator is off by 1 cm
  Eigen::Matrix2d state = Eigen::Matrix2d::Zero();
  for (int i = 0; i < 30000; ++i) {
    lqg.estimate(state.row(0), state.row(1));
    const Vec2 zmp = lqg.control({}, polygon, {}, true, true) + bias;
    state = (plant.a * state + plant.b * zmp.transpose()).eval();
  }
  EXPECT_LT(std::abs(state(0, 0)), 2e-4);
}

TEST(Lqg, WithoutTheAnkleTheZmpIsThePlannedOne) {
  Lqg lqg{Parameters()};
  const ConvexPolygon polygon = support_polygon(Sole{0.075, 0.0375}, foot_at(0.0, 0.0));
  lqg.estimate({0.1, 0.0}, {0.2, 0.0});
  const LqgReference reference{{0.0, 0.0}, {0.0, 0.0}, {0.02, 0.01}};
  EXPECT_EQ(lqg.control(reference, polygon, {}, false, true), reference.zmp);
}

}  // namespace
}  // namespace stagger::engine
