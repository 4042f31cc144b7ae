// The reference that the controller tracks: ZMP by eq. (1), DCM by the exact backward recursion,
// CoM as the exact response to them.
#pragma once

#include "engine/lipm.h"

namespace stagger::engine {

/// ZMP segments from now on, and the DCM in which they are to end. No heap.
class DcmPlan {
 public:
  static constexpr std::size_t capacity = 2 * 8 + 2;

  void clear() { count_ = 0; }
  void add(const ZmpSegment& segment) { segments_[count_++] = segment; }
  /// Backward recursion from the DCM at the end of the last segment.
  void solve(const Vec2& terminal_dcm, double omega);

  std::size_t size() const { return count_; }
  /// Reference DCM now, i.e. at the start of the first segment.
  const Vec2& dcm() const { return dcm_[0]; }
  /// Reference DCM at the end of segment i.
  const Vec2& dcm_at_end(std::size_t i) const { return dcm_[i + 1]; }
  /// Reference DCM after dt; where the plan has ended by then, its terminal DCM.
  Vec2 dcm_after(double dt, double omega) const;
  /// Reference ZMP now.
  Vec2 zmp() const { return segments_[0].zmp(0.0); }
  /// Where the CoM reference is after dt, starting from `com` now; passes over segment ends.
  Vec2 advance_com(Vec2 com, double dt, double omega) const;

 private:
  std::array<ZmpSegment, capacity> segments_;
  std::array<Vec2, capacity + 1>
      dcm_;  ///< at the start of each segment, and at the end of the last
  std::size_t count_ = 0;
};

/// DCM offset from the stance foot at the start of single support in a gait that repeats the two
/// steps `first` (away from this foot) and `second` for ever:
/// b = e^{-w Tss} gamma (s_1 + e^{-w T} s_2) / (1 - e^{-2 w T}).
Vec2 periodic_dcm_offset(const Vec2& first, const Vec2& second, double t_ss, double t_ds,
                         double omega);

/// ZMP at the start of Initialize such that a ZMP on a line from there to `first_stance` takes the
/// DCM from `dcm` (at rest: the CoM) to `dcm_end` in `duration`: no jump of velocity at the start.
Vec2 initial_zmp(const Vec2& dcm, const Vec2& first_stance, const Vec2& dcm_end, double duration,
                 double omega);

}  // namespace stagger::engine
