#include "sim/experiment/paper/plan.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "engine/reference.h"
#include "engine/swing.h"
#include "sim/experiment/paper/closed_loop.h"

namespace stagger::sim {
namespace {

constexpr int step_count = 6;
constexpr double step_length = 0.5;
constexpr double t_ss = 0.8;
constexpr double t_ds = 0.2;
constexpr double swing_height = 0.025;
constexpr double t_init = 1.0;

/// SS, DS, SS, ... and a last SS in which the CoM comes to rest over the last foot.
std::vector<engine::ZmpSegment> zmp_plan() {
  std::vector<engine::ZmpSegment> segments;
  const auto foot = [](int i) { return Vec2(step_length * i, step_length * i); };
  for (int i = 0; i < step_count; ++i) {
    segments.push_back({t_ss, foot(i), foot(i)});
    segments.push_back({t_ds, foot(i), foot(i + 1)});  // eq. (1)
  }
  segments.push_back({t_ss, foot(step_count), foot(step_count)});
  return segments;
}

/// CoM at the boundaries on one axis, as the boundary value problem of eq. (3) with a moving ZMP
/// has it: velocity continuous at every inner boundary, the CoM given at the start and the DCM on
/// the ZMP at the end. One linear system; nothing of the engine's recursion is in it.
Eigen::VectorXd boundary_value_nodes(const std::vector<engine::ZmpSegment>& segments, double com,
                                     double w) {
  // e_k = c_k - p_k; in a segment c = p + [e_b sinh(w tau) + e_a sinh(w (D - tau))] / sinh(w D).
  const auto n = static_cast<Eigen::Index>(segments.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + 1, n + 1);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n + 1);
  const auto slope = [&](Eigen::Index k) {
    return segments[static_cast<std::size_t>(k)].velocity().x();
  };
  const auto angle = [&](Eigen::Index k) {
    return w * segments[static_cast<std::size_t>(k)].duration;
  };
  a(0, 0) = 1.0;
  b(0) = com - segments.front().start.x();
  for (Eigen::Index k = 1; k < n; ++k) {
    a(k, k - 1) = 1.0 / std::sinh(angle(k - 1));
    a(k, k) = -1.0 / std::tanh(angle(k - 1)) - 1.0 / std::tanh(angle(k));
    a(k, k + 1) = 1.0 / std::sinh(angle(k));
    b(k) = (slope(k - 1) - slope(k)) / w;
  }
  a(n, n - 1) = -1.0 / std::sinh(angle(n - 1));
  a(n, n) = 1.0 + 1.0 / std::tanh(angle(n - 1));
  b(n) = -slope(n - 1) / w;
  Eigen::VectorXd nodes = a.partialPivLu().solve(b);
  for (Eigen::Index k = 0; k < n; ++k) nodes(k) += segments[static_cast<std::size_t>(k)].start.x();
  nodes(n) += segments.back().end.x();
  return nodes;
}

/// A point mass on one axis under c'' = w^2 (c - p), by the classical Runge-Kutta method.
struct PointMass {
  double com = 0.0;
  double velocity = 0.0;

  void integrate(double p, double p_rate, double h, double w) {
    const auto push = [&](double c, double tau) { return w * w * (c - p - p_rate * tau); };
    const double v1 = velocity;
    const double a1 = push(com, 0.0);
    const double v2 = velocity + 0.5 * h * a1;
    const double a2 = push(com + 0.5 * h * v1, 0.5 * h);
    const double v3 = velocity + 0.5 * h * a2;
    const double a3 = push(com + 0.5 * h * v2, 0.5 * h);
    const double v4 = velocity + h * a3;
    const double a4 = push(com + h * v3, h);
    com += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
    velocity += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
};

/// Velocity in a segment from its own closed form, the derivative of engine::com_after.
double velocity_in(const engine::ZmpSegment& s, double com, double dcm, double tau, double w) {
  const double half = 0.5 * (dcm - s.start.x() - s.velocity().x() / w);
  return s.velocity().x() + w * half * std::exp(w * tau) -
         w * (com - s.start.x() - half) * std::exp(-w * tau);
}

double ode_residual(const engine::ZmpSegment& s, const Vec2& com, const Vec2& dcm,
                    const Vec2& dcm_end, double w) {
  constexpr int parts = 1600;
  const double h = s.duration / parts;
  PointMass mass{com.x(), w * (dcm.x() - com.x())};
  double worst = 0.0;
  for (int i = 0; i < parts; ++i) {
    const double tau = h * i;
    mass.integrate(s.zmp(tau).x(), s.velocity().x(), h, w);
    const double c = engine::com_after(s, com, dcm, tau + h, w).x();
    const double z = engine::dcm_before(s, dcm_end, tau + h, w).x();
    worst = std::max({worst, std::abs(mass.com - c), std::abs(mass.com + mass.velocity / w - z)});
  }
  return worst;
}

}  // namespace

PlanResult run_plan() {
  const engine::Parameters parameters = paper_parameters();
  const double w = engine::natural_frequency(parameters);
  const std::vector<engine::ZmpSegment> segments = zmp_plan();
  engine::DcmPlan plan;
  plan.clear();
  for (const engine::ZmpSegment& segment : segments) plan.add(segment);
  plan.solve(segments.back().end, w);

  PlanResult result;
  const Vec2 start = segments.front().start;
  const Eigen::VectorXd independent = boundary_value_nodes(segments, start.x(), w);
  Vec2 com = start;
  double time = 0.0;
  double velocity_before = 0.0;
  for (std::size_t k = 0; k <= segments.size(); ++k) {
    const Vec2 dcm = k == 0 ? plan.dcm() : plan.dcm_at_end(k - 1);
    const double node = independent(static_cast<Eigen::Index>(k));
    result.nodes.push_back({time, com.x(), dcm.x(), node});
    result.max_node_error = std::max(result.max_node_error, std::abs(com.x() - node));
    if (k == segments.size()) break;
    const engine::ZmpSegment& s = segments[k];
    if (k > 0) {
      const double jump = velocity_in(s, com.x(), dcm.x(), 0.0, w) - velocity_before;
      result.max_velocity_jump = std::max(result.max_velocity_jump, std::abs(jump));
    }
    velocity_before = velocity_in(s, com.x(), dcm.x(), s.duration, w);
    result.max_ode_residual =
        std::max(result.max_ode_residual, ode_residual(s, com, dcm, plan.dcm_at_end(k), w));
    com = engine::com_after(s, com, dcm, s.duration, w);
    time += s.duration;
  }

  // From rest over the first foot: the ZMP starts off it and comes there on a straight line.
  const Vec2 first_zmp = engine::initial_zmp(start, start, plan.dcm(), t_init, w);
  result.start_zmp_offset = first_zmp.x() - start.x();
  const engine::ZmpSegment shift{t_init, first_zmp, start};
  result.start_velocity = w * (engine::dcm_before(shift, plan.dcm(), 0.0, w) - start).x();

  com = start;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const engine::ZmpSegment& s = segments[k];
    const Vec2 dcm = k == 0 ? plan.dcm() : plan.dcm_at_end(k - 1);
    const int ticks = static_cast<int>(std::lround(s.duration / parameters.tick));
    for (int i = 0; i < ticks; ++i) {
      const double tau = parameters.tick * i;
      TraceSample sample;
      sample.time = result.nodes[k].time + tau;
      sample.zmp.reference = s.zmp(tau);
      sample.com.reference = engine::com_after(s, com, dcm, tau, w);
      sample.dcm.reference = engine::dcm_before(s, plan.dcm_at_end(k), tau, w);
      result.references.push_back(sample);
    }
    com = engine::com_after(s, com, dcm, s.duration, w);
  }

  Side side = Side::left;
  for (int i = 0; i <= step_count; ++i) {
    result.steps.push_back({Vec2(step_length * i, step_length * i), 0.0, side});
    side = engine::other(side);
  }
  const auto pose = [](const engine::Footstep& step) {
    return engine::FootPose{Vec3(step.position.x(), step.position.y(), 0.0), step.yaw};
  };
  for (int i = 0; i < step_count; ++i) {
    // The foot that stood one step behind; the first one starts beside the stance foot.
    const auto at = static_cast<std::size_t>(i);
    engine::SwingTrajectory swing;
    swing.start(pose(result.steps[i == 0 ? 0 : at - 1]), pose(result.steps[at + 1]), t_ss,
                swing_height);
    std::vector<SwingSample> samples;
    const int ticks = static_cast<int>(std::lround(t_ss / parameters.tick));
    for (int tick = 0; tick <= ticks; ++tick) {
      const double tau = parameters.tick * tick;
      samples.push_back({(t_ss + t_ds) * i + tau, swing.at(tau).position});
    }
    result.swings.push_back(std::move(samples));
  }
  return result;
}

}  // namespace stagger::sim
