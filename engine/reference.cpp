#include "engine/reference.h"

#include <algorithm>

namespace stagger::engine {

void DcmPlan::solve(const Vec2& terminal_dcm, double omega) {
  dcm_[count_] = terminal_dcm;
  for (std::size_t i = count_; i-- > 0;) {
    dcm_[i] = dcm_before(segments_[i], dcm_[i + 1], 0.0, omega);
  }
}

Vec2 DcmPlan::advance_com(Vec2 com, double dt, double omega) const {
  for (std::size_t i = 0; i < count_ && dt > 0.0; ++i) {
    const bool last = i + 1 == count_;
    const double tau = last ? dt : std::min(dt, segments_[i].duration);
    com = com_after(segments_[i], com, dcm_[i], tau, omega);
    dt -= tau;
  }
  return com;
}

Vec2 DcmPlan::dcm_after(double dt, double omega) const {
  for (std::size_t i = 0; i < count_; ++i) {
    if (dt < segments_[i].duration) return dcm_before(segments_[i], dcm_[i + 1], dt, omega);
    dt -= segments_[i].duration;
  }
  return dcm_[count_];
}

Vec2 periodic_dcm_offset(const Vec2& first, const Vec2& second, double t_ss, double t_ds,
                         double omega) {
  const double decay = std::exp(-omega * (t_ss + t_ds));
  return std::exp(-omega * t_ss) * transfer_factor(t_ds, omega) * (first + decay * second) /
         (1.0 - decay * decay);
}

Vec2 initial_zmp(const Vec2& dcm, const Vec2& first_stance, const Vec2& dcm_end, double duration,
                 double omega) {
  const double e = std::exp(-omega * duration);
  const double share = (1.0 - e) / (omega * duration);
  return (dcm - first_stance * share - (dcm_end - first_stance) * e) / (1.0 - share);
}

}  // namespace stagger::engine
