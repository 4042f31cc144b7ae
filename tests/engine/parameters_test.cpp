#include "engine/parameters.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>

#include "engine/walking_engine.h"

namespace stagger::engine {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double no_limit = std::numeric_limits<double>::infinity();

/// What validate() says to these parameters; empty when it takes them.
std::string complaint(const Parameters& p) {
  try {
    validate(p);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

struct Field {
  const char* name;
  std::function<double&(Parameters&)> of;
  double too_small;  ///< NaN: any small value is allowed
};

const std::vector<Field>& fields() {
  static const std::vector<Field> all{
      {"tick", [](Parameters& p) -> double& { return p.tick; }, 0.0},
      {"gravity", [](Parameters& p) -> double& { return p.gravity; }, 0.0},
      {"com_height", [](Parameters& p) -> double& { return p.com_height; }, 0.0},
      {"mass", [](Parameters& p) -> double& { return p.mass; }, 0.0},
      {"t_ss", [](Parameters& p) -> double& { return p.t_ss; }, 0.0},
      {"t_ds", [](Parameters& p) -> double& { return p.t_ds; }, -0.1},
      {"t_init", [](Parameters& p) -> double& { return p.t_init; }, 0.0},
      {"stance_width", [](Parameters& p) -> double& { return p.stance_width; }, 0.09},
      {"swing_height", [](Parameters& p) -> double& { return p.swing_height; }, -0.01},
      {"foot_half_length", [](Parameters& p) -> double& { return p.foot_half_length; }, 0.0},
      {"foot_half_width", [](Parameters& p) -> double& { return p.foot_half_width; }, 0.0},
      {"sole_margin", [](Parameters& p) -> double& { return p.sole_margin; }, -0.001},
      {"ankle_reach (length)", [](Parameters& p) -> double& { return p.ankle_reach.x(); }, 0.0},
      {"ankle_reach (width)", [](Parameters& p) -> double& { return p.ankle_reach.y(); }, 0.0},
      {"max_step_length", [](Parameters& p) -> double& { return p.max_step_length; }, 0.0},
      {"max_step_back", [](Parameters& p) -> double& { return p.max_step_back; }, 0.0},
      {"min_step_width", [](Parameters& p) -> double& { return p.min_step_width; }, 0.08},
      {"max_step_width", [](Parameters& p) -> double& { return p.max_step_width; }, 0.19},
      {"max_step_turn", [](Parameters& p) -> double& { return p.max_step_turn; }, 0.0},
      {"foot_clearance", [](Parameters& p) -> double& { return p.foot_clearance; }, -0.01},
      {"lqr_state_weight (CoM)", [](Parameters& p) -> double& { return p.lqr_state_weight[0]; },
       -1.0},
      {"lqr_state_weight (DCM)", [](Parameters& p) -> double& { return p.lqr_state_weight[1]; },
       -1.0},
      {"lqr_state_weight (integral)",
       [](Parameters& p) -> double& { return p.lqr_state_weight[2]; }, -1.0},
      {"lqr_zmp_weight", [](Parameters& p) -> double& { return p.lqr_zmp_weight; }, 0.0},
      {"process_noise", [](Parameters& p) -> double& { return p.process_noise; }, 0.0},
      {"measurement_noise", [](Parameters& p) -> double& { return p.measurement_noise; }, 0.0},
      {"push_gate", [](Parameters& p) -> double& { return p.push_gate; }, 0.0},
      {"ankle_share", [](Parameters& p) -> double& { return p.ankle_share; }, 1.1},
      {"step_gain", [](Parameters& p) -> double& { return p.step_gain; }, -0.1},
      {"step_margin", [](Parameters& p) -> double& { return p.step_margin; }, -0.1},
      {"step_freeze", [](Parameters& p) -> double& { return p.step_freeze; }, -0.1},
      {"step_anew", [](Parameters& p) -> double& { return p.step_anew; }, -0.1},
      {"time_limit", [](Parameters& p) -> double& { return p.time_limit; }, -0.1},
      {"time_constant", [](Parameters& p) -> double& { return p.time_constant; }, 0.0},
      {"time_reach", [](Parameters& p) -> double& { return p.time_reach; }, 0.0},
      {"least_t_ss", [](Parameters& p) -> double& { return p.least_t_ss; }, 0.0},
      {"swing_speed", [](Parameters& p) -> double& { return p.swing_speed; }, 0.0},
      {"swing_acceleration", [](Parameters& p) -> double& { return p.swing_acceleration; }, 0.0},
      {"contact_load", [](Parameters& p) -> double& { return p.contact_load; }, -1.0},
      {"landing_patience", [](Parameters& p) -> double& { return p.landing_patience; }, -0.1},
      {"landing_speed", [](Parameters& p) -> double& { return p.landing_speed; }, -0.1},
      {"landing_acceleration", [](Parameters& p) -> double& { return p.landing_acceleration; },
       -0.1},
      {"landing_rate", [](Parameters& p) -> double& { return p.landing_rate; }, -0.1},
      {"hold_load", [](Parameters& p) -> double& { return p.hold_load; }, -0.1},
      {"hip.torque", [](Parameters& p) -> double& { return p.hip.torque; }, -1.0},
      {"hip.inertia", [](Parameters& p) -> double& { return p.hip.inertia; }, 0.0},
      {"hip.angle", [](Parameters& p) -> double& { return p.hip.angle; }, -0.1},
      {"hip.rate", [](Parameters& p) -> double& { return p.hip.rate; }, -1.0},
  };
  return all;
}

TEST(Parameters, TheDefaultsAreValid) { EXPECT_EQ(complaint({}), ""); }

TEST(Parameters, EveryFieldRefusesNonsenseByItsName) {
  for (const Field& field : fields()) {
    for (const double bad : {no_number, no_limit, -no_limit, field.too_small}) {
      Parameters p;
      field.of(p) = bad;
      const std::string text = complaint(p);
      EXPECT_EQ(text.find("engine parameter " + std::string(field.name) + " = "), 0U)
          << field.name << " = " << bad << ": " << text;
      EXPECT_NE(text.find("; allowed: "), std::string::npos) << text;
    }
  }
}

TEST(Parameters, SaysValueAndAllowedRange) {
  Parameters p;
  p.t_ds = -0.25;
  EXPECT_EQ(complaint(p), "engine parameter t_ds = -0.25; allowed: 0 to 60 s");
}

TEST(Parameters, UnlimitedStaysAllowed) {
  Parameters p;
  p.swing_speed = p.swing_acceleration = p.step_anew = 1e9;
  p.hip.rate = p.hip.torque = p.push_gate = p.landing_patience = 1e9;
  EXPECT_EQ(complaint(p), "");
}

/// The complaint begins with the name of a field that the rule is about.
void expect_refused(const char* field, const std::function<void(Parameters&)>& change) {
  Parameters p;
  change(p);
  EXPECT_EQ(complaint(p).find("engine parameter " + std::string(field) + " = "), 0U)
      << complaint(p);
}

TEST(Parameters, ValuesHaveToGoTogether) {
  expect_refused("t_ss", [](Parameters& p) { p.tick = 0.02, p.t_ss = p.least_t_ss = 0.09; });
  expect_refused("least_t_ss", [](Parameters& p) { p.tick = 0.04; });
  expect_refused("least_t_ss", [](Parameters& p) { p.least_t_ss = 0.9; });
  expect_refused("step_freeze", [](Parameters& p) { p.step_freeze = 0.8; });
  expect_refused("sole_margin", [](Parameters& p) { p.sole_margin = 0.0375; });
  expect_refused("stance_width", [](Parameters& p) { p.min_step_width = 0.25; });
  expect_refused("max_step_width", [](Parameters& p) { p.stance_width = 0.7; });
  expect_refused("min_step_width", [](Parameters& p) { p.foot_half_width = 0.05; });
  expect_refused("min_step_width", [](Parameters& p) { p.foot_clearance = 0.03; });
  expect_refused("min_step_width",
                 [](Parameters& p) { p.min_step_width = p.stance_width = p.max_step_width = 0.2; });
}

TEST(Parameters, CrossingFreesTheLeastWidthButNotTheStance) {
  Parameters p;
  p.min_step_width = -0.2;
  EXPECT_NE(complaint(p), "");
  p.allow_crossing = true;
  EXPECT_EQ(complaint(p), "");
  p.min_step_width = -0.7;
  EXPECT_NE(complaint(p), "");
  p.min_step_width = 0.0;
  p.stance_width = 0.08;
  EXPECT_NE(complaint(p), "");
}

std::string refusal_of_an_engine(const Parameters& p, const Measurement& start) {
  try {
    const WalkingEngine engine(p, start);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

Measurement standing() {
  Measurement m;
  m.com = {0.0, 0.0, 1.0};
  m.feet[0].position = {0.0, 0.1, 0.0};
  m.feet[1].position = {0.0, -0.1, 0.0};
  return m;
}

TEST(Parameters, NoEngineIsMadeOfNonsense) {
  EXPECT_EQ(refusal_of_an_engine({}, standing()), "");
  for (const Field& field : fields()) {
    Parameters p;
    field.of(p) = no_number;
    EXPECT_NE(refusal_of_an_engine(p, standing()), "") << field.name;
  }
  Measurement lost = standing();
  lost.com.x() = no_number;
  EXPECT_NE(refusal_of_an_engine({}, lost), "");
  lost = standing();
  lost.feet[1].yaw = no_limit;
  EXPECT_NE(refusal_of_an_engine({}, lost), "");
}

TEST(Parameters, WeightsWithoutAControllerAreRefusedWithTheCure) {
  for (const Vec3& weights : {Vec3(0.0, 0.0, 0.0), Vec3(1.0, 100.0, 1e-12)}) {
    Parameters p;
    p.lqr_state_weight = weights;
    const std::string text = refusal_of_an_engine(p, standing());
    EXPECT_NE(text.find("lqr_state_weight"), std::string::npos) << weights.transpose();
    EXPECT_NE(text.find("either 0 (no integrator) or not small"), std::string::npos) << text;
  }
  // The integral sees the CoM, and that the DCM: any one of the weights will do.
  for (const Vec3& weights : {Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0), Vec3(0.0, 0.0, 1.0)}) {
    Parameters p;
    p.lqr_state_weight = weights;
    EXPECT_EQ(refusal_of_an_engine(p, standing()), "") << weights.transpose();
  }
}

}  // namespace
}  // namespace stagger::engine
