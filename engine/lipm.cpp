#include "engine/lipm.h"

#include <algorithm>

namespace stagger::engine {

Vec2 ZmpSegment::velocity() const {
  if (duration <= 0.0) return Vec2::Zero();
  return (end - start) / duration;
}

Vec2 ZmpSegment::zmp(double tau) const {
  if (duration <= 0.0) return end;
  return start + (end - start) * std::clamp(tau / duration, 0.0, 1.0);
}

Vec2 dcm_before(const ZmpSegment& segment, const Vec2& dcm_end, double tau, double omega) {
  if (segment.duration <= 0.0) return dcm_end;
  const Vec2 lead = segment.velocity() / omega;
  return segment.zmp(tau) + lead +
         (dcm_end - segment.end - lead) * std::exp(-omega * (segment.duration - tau));
}

Vec2 com_after(const ZmpSegment& segment, const Vec2& com_start, const Vec2& dcm_start, double tau,
               double omega) {
  const Vec2 start = segment.zmp(0.0);  // of a segment of no duration that is its end
  const Vec2 half = 0.5 * (dcm_start - start - segment.velocity() / omega);
  return segment.zmp(tau) + half * std::exp(omega * tau) +
         (com_start - start - half) * std::exp(-omega * tau);
}

double transfer_factor(double t_ds, double omega) {
  const double x = omega * t_ds;
  return x < 1e-9 ? 1.0 : -std::expm1(-x) / x;
}

DiscreteLipm discretise(double omega, double dt) {
  const double e = std::exp(omega * dt);
  DiscreteLipm lipm;
  lipm.a << 1.0 / e, 0.5 * (e - 1.0 / e), 0.0, e;
  lipm.b << 1.0 - 0.5 * (e + 1.0 / e), 1.0 - e;
  return lipm;
}

}  // namespace stagger::engine
