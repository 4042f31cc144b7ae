// The hip strategy: angular momentum about the CoM as one more way to push against the ground.
#pragma once

#include "engine/parameters.h"

namespace stagger::engine {

/// How far the DCM is beyond what feet and steps can bring back, towards plus and minus on one
/// axis; negative while it is within [m].
struct Excess {
  double plus = 0.0;
  double minus = 0.0;
};

/// A flywheel at the CoM for each axis: a torque tau on the wheel acts on the CoM like a ZMP that
/// is tau / (m g) farther out (Pratt et al. 2006, "Capture point"). Bang-bang: full torque while
/// the DCM would otherwise be lost, full braking in time to stop inside the angle limit, and a slow
/// return to upright with what the ankle has to spare. From rest it saves an excess of less than
/// tau / (m g) (1 - e^{-w T1})^2, T1 = sqrt(J theta_max / tau); nothing saves more.
class HipStrategy {
 public:
  HipStrategy(const HipParameters& hip, double weight, double omega, double tick);

  /// Decides the torque of this tick. `spare`: how far the ZMP command is from the edge [m].
  void update(const std::array<Excess, 2>& excess, double spare, bool act);

  /// Shift of the effective ZMP that acts this tick [m].
  const Vec2& zmp_shift() const { return shift_; }
  /// +1 or -1 on an axis while a swing that way is under way, its braking included: the ZMP then
  /// belongs at that edge of the foot, wherever the DCM is.
  const Vec2& swing() const { return swing_; }
  /// Lean of the wheels: about +y for the first axis, about -x for the second [rad].
  const Vec2& angle() const { return angle_; }
  const Vec2& rate() const { return rate_; }  ///< [rad/s]

 private:
  /// For a lean counted positive outwards: all that still lets the wheel stop inside its limits.
  double outward_torque(double angle, double rate) const;
  double axis_torque(int axis, const Excess& excess, double spare);

  HipParameters hip_;
  double weight_;  ///< m g [N]
  double omega_;
  double tick_;
  Vec2 shift_ = Vec2::Zero();
  Vec2 swing_ = Vec2::Zero();
  Vec2 angle_ = Vec2::Zero();
  Vec2 rate_ = Vec2::Zero();
};

}  // namespace stagger::engine
