#include "sim/control/contact_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "sim/noise.h"

namespace stagger::sim {
namespace {

constexpr double dt = 0.001;
constexpr double gravity = 9.81;

ContactFilterNoise typical() {
  ContactFilterNoise noise;
  noise.gyro = 0.0014;
  noise.accelerometer = 0.031;
  noise.gyro_walk = 1e-5;
  noise.accelerometer_walk = 1e-5;
  noise.leg = 2e-4;
  noise.start_tilt = 0.002;
  noise.start_velocity = 1e-3;
  noise.gyro_bias = 0.0017;
  noise.accelerometer_bias = 0.02;
  return noise;
}

Eigen::Quaterniond turn_by(const Vec3& vector) {
  if (vector.norm() == 0.0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(vector.norm(), vector.normalized()));
}

/// A base that sways above two feet that stand, and what an inertial unit and legs say about it.
class Sway {
 public:
  Sway(const Vec3& place, std::uint64_t seed, double noise) : noise_(seed), share_(noise) {
    position = start_ = place;
    for (std::size_t i = 0; i < 2; ++i) feet[i] = place + Vec3(0.02, i == 0 ? 0.1 : -0.1, -0.9);
    for (double& x : gyro_bias) x = share_ * typical().gyro_bias * noise_();
    for (double& x : accelerometer_bias) x = share_ * typical().accelerometer_bias * noise_();
  }

  void step() {
    t_ += dt;
    const Vec3 rate(0.3 * std::sin(4.0 * t_), 0.2 * std::cos(5.0 * t_), 0.5 * std::sin(2.0 * t_));
    const Vec3 next(0.03 * (1.0 - std::cos(6.0 * t_)), 0.05 * (1.0 - std::cos(5.0 * t_)),
                    0.01 * (1.0 - std::cos(9.0 * t_)));
    const Vec3 next_velocity(0.18 * std::sin(6.0 * t_), 0.25 * std::sin(5.0 * t_),
                             0.09 * std::sin(9.0 * t_));
    const Eigen::Quaterniond middle = orientation * turn_by(0.5 * dt * rate);
    angular_velocity = rate + gyro_bias;
    specific_force =
        middle.conjugate() * ((next_velocity - velocity) / dt + Vec3(0.0, 0.0, gravity)) +
        accelerometer_bias;
    for (double& x : angular_velocity) x += share_ * typical().gyro * noise_();
    for (double& x : specific_force) x += share_ * typical().accelerometer * noise_();
    orientation = orientation * turn_by(dt * rate);
    position = start_ + next;
    velocity = next_velocity;
  }

  Vec3 foot_in_base(std::size_t foot) {
    Vec3 seen = orientation.conjugate() * (feet[foot] - position);
    for (double& x : seen) x += share_ * typical().leg * noise_();
    return seen;
  }

  Vec3 position;
  Vec3 velocity = Vec3::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  PerFoot<Vec3> feet;
  Vec3 gyro_bias;
  Vec3 accelerometer_bias;
  Vec3 angular_velocity;
  Vec3 specific_force;

 private:
  Noise noise_;
  double share_;
  Vec3 start_;
  double t_ = 0.0;
};

/// Both feet stand; each tick the sway and the filter go on together.
ContactFilter standing(Sway& sway, const Eigen::Quaterniond& orientation) {
  ContactFilter filter(typical(), dt, gravity, sway.position, orientation);
  for (std::size_t i = 0; i < 2; ++i) filter.plant(i, sway.foot_in_base(i));
  return filter;
}

void tick(ContactFilter& filter, Sway& sway) {
  sway.step();
  filter.predict(sway.angular_velocity, sway.specific_force);
  for (std::size_t i = 0; i < 2; ++i) {
    filter.shift(i, Vec3::Zero(), 1e-6);
    filter.see(i, sway.foot_in_base(i));
  }
}

double tilt_error(const ContactFilter& filter, const Sway& sway) {
  const Vec3 up = filter.orientation() * (sway.orientation.conjugate() * Vec3::UnitZ());
  return up.head<2>().norm();
}

TEST(ContactFilter, FindsTiltVelocityAndGyroBias) {
  Sway sway(Vec3(0.0, 0.0, 0.9), 1, 1.0);
  ContactFilter filter = standing(sway, turn_by(Vec3(0.003, -0.003, 0.0)));
  for (int i = 0; i < 20000; ++i) tick(filter, sway);
  EXPECT_LT(tilt_error(filter, sway), 0.004);  // what an accelerometer's bias of 0.02 m/s^2 hides
  EXPECT_LT((filter.velocity() - sway.velocity).norm(), 0.003);
  EXPECT_LT((filter.gyro_bias() - sway.gyro_bias).norm(), 2e-4);
  EXPECT_GT(sway.gyro_bias.norm(), 1e-3);
}

TEST(ContactFilter, IsAsSureAsItIsRight) {
  // Mean of the squared error of the tilt and velocity in units of its own covariance: 5 if honest.
  double sum = 0.0;
  constexpr int runs = 40;
  for (int run = 0; run < runs; ++run) {
    Sway sway(Vec3(0.0, 0.0, 0.9), 100 + run, 1.0);
    Noise start(1000 + run);
    const double x = 0.002 * start();
    ContactFilter filter = standing(sway, turn_by(Vec3(x, 0.002 * start(), 0.0)));
    for (int i = 0; i < 2000; ++i) tick(filter, sway);
    const Eigen::AngleAxisd turn(sway.orientation * filter.orientation().conjugate());
    const Vec3 turned = turn.angle() * turn.axis();
    Eigen::Matrix<double, 5, 1> error;
    error << turned.head<2>(), sway.velocity - turn_by(turned) * filter.velocity();
    Eigen::Matrix<double, 5, 5> p;
    const int at[] = {0, 1, 3, 4, 5};
    for (int i = 0; i < 5; ++i) {
      for (int j = 0; j < 5; ++j) p(i, j) = filter.covariance()(at[i], at[j]);
    }
    sum += error.dot(p.inverse() * error);
  }
  EXPECT_GT(sum / runs, 2.5);
  EXPECT_LT(sum / runs, 8.0);
}

TEST(ContactFilter, ItsCovarianceStaysOne) {
  Sway sway(Vec3(0.0, 0.0, 0.9), 3, 1.0);
  ContactFilter filter = standing(sway, Eigen::Quaterniond::Identity());
  for (int i = 0; i < 30000; ++i) {
    tick(filter, sway);
    if (i % 500 == 0) filter.lift(static_cast<std::size_t>(i / 500 % 2));
    if (i % 500 == 250) {
      const auto foot = static_cast<std::size_t>(i / 500 % 2);
      filter.plant(foot, sway.foot_in_base(foot));
    }
  }
  const ContactFilter::Covariance& p = filter.covariance();
  EXPECT_LT((p - p.transpose()).cwiseAbs().maxCoeff(), 1e-12);
  const Eigen::SelfAdjointEigenSolver<ContactFilter::Covariance> solver(p);
  EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-12);
}

TEST(ContactFilter, AFootThatSlipsDoesNotTurnTheWorld) {
  Sway sway(Vec3(0.0, 0.0, 0.9), 4, 1.0);
  ContactFilter filter = standing(sway, Eigen::Quaterniond::Identity());
  for (int i = 0; i < 5000; ++i) tick(filter, sway);
  for (int i = 0; i < 20; ++i) {  // the left foot, 5 cm in 20 ms
    sway.feet[0].x() += 0.0025;
    tick(filter, sway);
  }
  for (int i = 0; i < 2000; ++i) tick(filter, sway);
  EXPECT_LT(filter.orientation().angularDistance(sway.orientation), 0.02);
  EXPECT_LT(tilt_error(filter, sway), 0.006);
  EXPECT_LT((filter.velocity() - sway.velocity).norm(), 0.01);
  EXPECT_NEAR((filter.foot(0) - filter.foot(1)).x(), 0.05, 0.01);
}

TEST(ContactFilter, FollowsABlowThatTheFeetDoNot) {
  // 300 m/s^2 for 10 ms while both feet stay: the leg says so too, and nothing is gated away.
  ContactFilter filter(typical(), dt, gravity, Vec3(0.0, 0.0, 0.9), Eigen::Quaterniond::Identity());
  Vec3 position(0.0, 0.0, 0.9);
  Vec3 velocity = Vec3::Zero();
  const Vec3 foot = Vec3::Zero();
  filter.plant(0, foot - position);
  for (int i = 0; i < 30; ++i) {
    const Vec3 acceleration(i < 10 ? 300.0 : 0.0, 0.0, 0.0);
    filter.predict(Vec3::Zero(), acceleration + Vec3(0.0, 0.0, gravity));
    position += dt * (velocity + 0.5 * dt * acceleration);
    velocity += dt * acceleration;
    filter.see(0, foot - position);
    EXPECT_NEAR((filter.velocity() - velocity).norm(), 0.0, 1e-6);
  }
  EXPECT_NEAR(velocity.x(), 3.0, 1e-9);
}

TEST(ContactFilter, FarFromTheOriginItKnowsAsMuch) {
  const auto after = [](const Vec3& place) {
    Sway sway(place, 5, 1.0);
    ContactFilter filter = standing(sway, Eigen::Quaterniond::Identity());
    for (int i = 0; i < 3000; ++i) tick(filter, sway);
    return filter;
  };
  const ContactFilter near = after(Vec3(0.0, 0.0, 0.9));
  const ContactFilter far = after(Vec3(1e4, -1e4, 0.9));
  EXPECT_LT(near.orientation().angularDistance(far.orientation()), 1e-6);
  EXPECT_LT((near.velocity() - far.velocity()).norm(), 1e-6);
}

}  // namespace
}  // namespace stagger::sim
