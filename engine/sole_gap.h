// How far two soles are from each other: exact, for rectangles turned against each other.
#pragma once

#include "engine/support_polygon.h"

namespace stagger::engine {

/// Least distance between two equal soles [m]; the second has its centre at `offset` and is turned
/// by `turn` [rad], both in the frame of the first. Negative where they overlap: then how far they
/// would have to be moved apart.
double sole_gap(const Sole& sole, const Vec2& offset, double turn);

/// sole_gap() >= clearance, for less work where the feet are well apart; clearance >= 0 [m].
bool soles_clear(const Sole& sole, const Vec2& offset, double turn, double clearance);

}  // namespace stagger::engine
