#include "engine/hip_strategy.h"

#include <algorithm>
#include <cmath>

namespace stagger::engine {
namespace {

/// Of what the ankle has to spare, the part that the return to upright may use up.
constexpr double return_share = 0.5;
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

double HipStrategy::axis_torque(int axis, const Excess& excess, double spare) {
  const double angle = angle_[axis];
  const double rate = rate_[axis];
  const double most = hip_.torque;
  // The torque that stops the wheel within one tick, if the motor can.
  const double stop = std::clamp(-rate * hip_.inertia / tick_, -most, most);

  for (const double way : {1.0, -1.0}) {
    const double beyond = way > 0.0 ? excess.plus : excess.minus;
    const bool turning = way * rate > 0.0;
    if (beyond <= 0.0 && !turning) continue;
    // While the wheel brakes it drives the DCM out again: by then it must be this far inside.
    const double braking_time = turning ? std::abs(rate) * hip_.inertia / most : 0.0;
    const double needed = most / weight_ * -std::expm1(-omega_ * braking_time);
    if (beyond + needed <= 0.0) continue;
    // One more tick of full torque, if the wheel can then still be stopped inside its limits.
    const double next_rate = rate + way * most * tick_ / hip_.inertia;
    const double next_angle = angle + 0.5 * (rate + next_rate) * tick_;
    const double stopping = 0.5 * next_rate * std::abs(next_rate) * hip_.inertia / most;
    const bool room = way * (next_angle + stopping) <= hip_.angle && way * next_rate <= hip_.rate;
    swing_[axis] = way;
    return room ? way * most : stop;
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
