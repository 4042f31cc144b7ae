#include "engine/hip_strategy.h"

#include <algorithm>
#include <cmath>

namespace stagger::engine {
namespace {

/// Of what the ankle has to spare, the part that the return to upright may use up.
constexpr double return_share = 0.5;
/// How far inside a swing leaves the DCM if it can, as a part of the area's width.
constexpr double swing_reserve = 0.15;
/// Return to upright: at most this rate for each radian of lean [1/s].
constexpr double return_frequency = 4.0;

}  // namespace

HipStrategy::HipStrategy(const HipParameters& hip, double weight, double omega, double tick)
    : hip_(hip), weight_(weight), omega_(omega), tick_(tick) {}

void HipStrategy::update(const std::array<Excess, 2>& excess, double spare, bool act) {
  for (int axis = 0; axis < 2; ++axis) {
    const double torque =
        act ? axis_torque(axis, excess[static_cast<std::size_t>(axis)], spare) : 0.0;
    shift_[axis] = torque / weight_;
    const double acceleration = torque / hip_.inertia;
    angle_[axis] += (rate_[axis] + 0.5 * acceleration * tick_) * tick_;
    rate_[axis] += acceleration * tick_;
  }
}

double HipStrategy::outward_torque(double angle, double rate) const {
  // The rate after this tick from which full braking stops at the limit: angle' + rate'^2 J / (2
  // tau) = limit with angle' = angle + (rate + rate') dt / 2. The last part of a tick in which the
  // wheel comes to rest takes it this much farther:
  const double rounding = hip_.torque / hip_.inertia * tick_ * tick_ / 8.0;
  const double room = hip_.angle - rounding - angle - 0.5 * rate * tick_;
  const double braking = hip_.torque / hip_.inertia;
  const double half = 0.5 * braking * tick_;
  const double root = half * half + 2.0 * braking * room;
  const double next = root > half * half ? std::sqrt(root) - half : 0.0;
  const double torque = (std::min(next, hip_.rate) - rate) * hip_.inertia / tick_;
  return std::clamp(torque, -hip_.torque, hip_.torque);
}

double HipStrategy::axis_torque(int axis, const Excess& excess, double spare) {
  const double angle = angle_[axis];
  const double rate = rate_[axis];
  const double most = hip_.torque;
  // The torque that stops the wheel within one tick, if the motor can.
  const double stop = std::clamp(-rate * hip_.inertia / tick_, -most, most);

  for (const double way : {1.0, -1.0}) {
    const double beyond = way > 0.0 ? excess.plus : excess.minus;
    const double width = -(excess.plus + excess.minus);
    const bool turning = way * rate > 0.0;
    if (beyond <= 0.0 && !turning) continue;
    // While the wheel brakes it drives the DCM out again: by then it must be this far inside. From
    // the very edge it would take for ever to come back.
    const double braking_time = turning ? std::abs(rate) * hip_.inertia / most : 0.0;
    const double needed = most / weight_ * -std::expm1(-omega_ * braking_time) +
                          (swing_[axis] == way ? swing_reserve * width : 0.0);
    if (beyond + needed <= 0.0) continue;
    swing_[axis] = way;
    return way * outward_torque(way * angle, way * rate);
  }

  // The swing has done enough: brake as hard as was reckoned with.
  if (swing_[axis] * rate > 0.0) return stop;
  swing_[axis] = 0.0;

  // What the ankle can make up for. Full braking only where gentle braking would run into the
  // limit.
  const double gentle = std::min(most, return_share * std::max(spare, 0.0) * weight_);
  const double gentle_rate = std::sqrt(gentle / hip_.inertia * std::abs(angle));
  const bool outwards = rate * angle > 0.0;
  if (outwards && 2.0 * gentle * (hip_.angle - std::abs(angle)) < hip_.inertia * rate * rate) {
    return stop;
  }
  // On the way home never faster than gentle braking can stop at upright.
  const double home_rate = std::clamp(-return_frequency * angle, -gentle_rate, gentle_rate);
  const double torque = hip_.inertia * 2.0 * return_frequency * (home_rate - rate);
  return std::clamp(torque, -gentle, gentle);
}

}  // namespace stagger::engine
