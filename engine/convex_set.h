// Convex sets of the plane as lists of corners: any number of them, also a single point or a
// segment. For set-up, not for the tick.
#pragma once

#include <vector>

#include "engine/convex_polygon.h"

namespace stagger::engine {

/// Corners of a convex set, counter-clockwise.
using ConvexSet = std::vector<Vec2>;

ConvexSet corners(const ConvexPolygon& polygon);
/// Hull of any points; corners that stick out by no more than a rounding error are left out.
ConvexSet convex_hull(std::vector<Vec2> points);
ConvexSet hull_of(const ConvexSet& a, const ConvexSet& b);
/// Cut down to as many corners as a polygon can have, each time by the one that costs the least
/// area: nothing is added. At least three corners.
ConvexPolygon inner_polygon(ConvexSet set);
/// { a + b }.
ConvexSet minkowski_sum(const ConvexSet& a, const ConvexSet& b);
ConvexSet scaled(const ConvexSet& set, double factor);
ConvexSet shifted(const ConvexSet& set, const Vec2& by);
/// Mirror image in the x axis: what holds for the left foot, for the right one.
ConvexSet mirrored(const ConvexSet& set);

/// Largest t with t * direction inside the set, or a negative number when the set and the ray from
/// the origin do not meet.
double ray_exit(const ConvexSet& set, const Vec2& direction);
/// Distance by which a point is inside (negative: outside) the nearest edge; sets of three or more
/// corners.
double margin(const ConvexSet& set, const Vec2& point);

}  // namespace stagger::engine
