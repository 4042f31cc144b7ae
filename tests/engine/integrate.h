// Independent check of the closed forms: the LIPM's differential equation, integrated numerically.
#pragma once

#include <functional>

#include "engine/types.h"

namespace stagger::testing {

struct PointMass {
  engine::Vec2 com = engine::Vec2::Zero();
  engine::Vec2 velocity = engine::Vec2::Zero();
  engine::Vec2 dcm(double omega) const { return com + velocity / omega; }
};

/// c'' = w^2 (c - p(t)) by the classical Runge-Kutta method of fourth order.
inline PointMass integrate(PointMass state, const std::function<engine::Vec2(double)>& zmp,
                           double duration, double omega, int steps) {
  const double h = duration / steps;
  const auto slope = [&](const PointMass& s, double t) {
    return PointMass{s.velocity, omega * omega * (s.com - zmp(t))};
  };
  const auto plus = [](const PointMass& s, const PointMass& d, double scale) {
    return PointMass{s.com + scale * d.com, s.velocity + scale * d.velocity};
  };
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const PointMass k1 = slope(state, t);
    const PointMass k2 = slope(plus(state, k1, h / 2), t + h / 2);
    const PointMass k3 = slope(plus(state, k2, h / 2), t + h / 2);
    const PointMass k4 = slope(plus(state, k3, h), t + h);
    state = plus(plus(plus(plus(state, k1, h / 6), k2, h / 3), k3, h / 3), k4, h / 6);
  }
  return state;
}

}  // namespace stagger::testing
