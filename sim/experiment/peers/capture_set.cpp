#include "sim/experiment/peers/capture_set.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/lipm.h"
#include "engine/reference.h"

namespace stagger::sim {
namespace {

using engine::Side;
using engine::Vec2;
using Polygon = CaptureSet::Polygon;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Andrew's monotone chain. Points within rounding of an edge are left out, or their number would
/// grow from step to step.
Polygon hull(Polygon points) {
  constexpr double rounding = 1e-15;
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  Polygon chain;
  const auto push = [&](const Vec2& p, std::size_t floor) {
    while (chain.size() >= floor + 2 &&
           cross(chain.back() - chain[chain.size() - 2], p - chain[chain.size() - 2]) <= rounding) {
      chain.pop_back();
    }
    chain.push_back(p);
  };
  for (const Vec2& p : points) push(p, 0);
  const std::size_t lower = chain.size() - 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) push(points[i], lower);
  chain.pop_back();  // repeats the first
  return chain;
}

Polygon sum(const engine::ConvexPolygon& reach, const Polygon& set) {
  Polygon points;
  for (std::size_t i = 0; i < reach.size(); ++i) {
    for (const Vec2& p : set) points.push_back(reach.vertex(i) + p);
  }
  return hull(points);
}

Polygon mirrored(Polygon polygon) {
  for (Vec2& p : polygon) p.y() = -p.y();
  std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

/// Union of e^{-w T} times the polygon over all T from `earliest` to `latest`.
Polygon before(const Polygon& polygon, double earliest, double latest, double omega) {
  Polygon points;
  for (const Vec2& p : polygon) {
    points.emplace_back(std::exp(-omega * earliest) * p);
    points.emplace_back(std::exp(-omega * latest) * p);
  }
  return hull(points);
}

double margin_in(const Polygon& polygon, const Vec2& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 edge = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
    least = std::min(least, cross(edge, point - polygon[i]));
  }
  return least;
}

}  // namespace

CaptureSet::CaptureSet(const PointWalker& walker) : omega_(walker.omega) {
  const engine::ConvexPolygon& reach = walker.reach.polygon(Side::left);
  Polygon set{Vec2::Zero()};
  // Until a step more changes nothing that a double can hold.
  const double contraction = walker.omega * walker.t_min;
  for (double done = 0.0; done < 40.0; done += contraction) {
    set = before(sum(reach, mirrored(set)), walker.t_min, walker.t_max, omega_);
  }
  sets_ = {set, mirrored(set)};
  const Polygon landing = sum(reach, mirrored(set));
  landings_ = {landing, mirrored(landing)};
}

double CaptureSet::margin(Side stance, const Vec2& dcm_offset) const {
  return margin_in(polygon(stance), dcm_offset);
}

double CaptureSet::margin(Side stance, const Vec2& dcm_offset, double earliest,
                          double latest) const {
  return margin_in(before(landings_[engine::index(stance)], earliest, latest, omega_), dcm_offset);
}

bool walks_on(const PointWalker& walker, Side stance, const Vec2& dcm_offset) {
  const double time = walker.t_min;
  const auto middling_step = [&](Side from) {
    const engine::ConvexPolygon& reach = walker.reach.polygon(from);
    Vec2 mean = Vec2::Zero();
    for (std::size_t i = 0; i < reach.size(); ++i) mean += reach.vertex(i);
    return Vec2(mean / static_cast<double>(reach.size()));
  };
  const auto middling_offset = [&](Side on) {
    return engine::periodic_dcm_offset(middling_step(on), middling_step(engine::other(on)), time,
                                       0.0, walker.omega);
  };
  constexpr double lost = 10.0;
  constexpr double settled = 1e-9;
  constexpr int steps = 1000;  // on the very edge of what can be caught neither end is reached
  Vec2 offset = dcm_offset;
  for (int i = 0; i < steps; ++i) {
    if (!(offset.norm() < lost)) return false;
    if ((offset - middling_offset(stance)).norm() < settled) return true;
    const Vec2 touchdown = engine::dcm_after(offset, Vec2::Zero(), time, walker.omega);
    const Vec2 wanted = touchdown - middling_offset(engine::other(stance));
    offset = touchdown - walker.reach.polygon(stance).clamp(wanted);
    stance = engine::other(stance);
  }
  return true;
}

}  // namespace stagger::sim
