// How the ground goes on where nobody has stepped yet, guessed from where the feet have stood.
#pragma once

#include "engine/types.h"

namespace stagger::engine {

/// A gradient that is learnt from pairs of footholds (normalised least mean squares): single tiles
/// and stones average out, a slope remains. On level ground what is within the tolerance teaches
/// nothing: there the slope stays exactly zero.
class GroundSlope {
 public:
  /// Takes in that the ground goes from one foothold to the other [m].
  void learn(const Vec3& from, const Vec3& to);
  /// Rise along a way over the ground [m].
  double rise(const Vec2& way) const { return gradient_.dot(way); }
  const Vec2& gradient() const { return gradient_; }

  /// Share of the error that a pair of footholds corrects: a slope is known after some six steps,
  /// and a tile of 2 cm moves the next landing by half a centimetre.
  static constexpr double rate = 0.3;
  static constexpr double most = 0.2;  ///< no ground is taken to be steeper
  /// Feet on level ground miss its height by this much when a step is cut short [m].
  static constexpr double tolerance = 0.002;

 private:
  Vec2 gradient_ = Vec2::Zero();
};

}  // namespace stagger::engine
