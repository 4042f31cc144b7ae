#include "sim/experiment/peers/tracking.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "engine/lqg.h"
#include "engine/walking_engine.h"
#include "sim/experiment/peers/csv_table.h"
#include "sim/plant/lipm_plant.h"

namespace stagger::sim {
namespace {

using engine::Side;
using engine::Vec2;

const double omega = std::sqrt(9.81);
constexpr double walk_end = 10.0;  // [s]
// Half the size of the band around one foot, as the controller with limits was given it.
constexpr engine::Sole sole{0.05, 0.025};

Vec2 pair(const CsvTable& table, std::size_t row, const std::string& name) {
  return {table.number(row, name + "_x"), table.number(row, name + "_y")};
}

bool kicked_between(double from, double to) {
  return std::any_of(walk_kicks.begin(), walk_kicks.end(),
                     [&](double kick) { return kick > from + 1e-9 && kick <= to + 1e-9; });
}

}  // namespace

std::vector<Band> read_band(const std::string& file) {
  const CsvTable table(file);
  std::vector<Band> bands;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    bands.push_back({pair(table, row, "ref_zmp_min"), pair(table, row, "ref_zmp_max")});
  }
  return bands;
}

Trajectory read_trajectory(const std::string& file) {
  const CsvTable table(file);
  Trajectory t;
  t.name = std::filesystem::path(file).stem();
  if (table.rows() < 2) throw std::runtime_error(file + ": no trajectory");
  t.tick = table.number(1, "time") - table.number(0, "time");
  t.band = !table.has("ref_zmp_x");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    t.com.push_back(pair(table, row, "com_pos"));
    t.dcm.push_back(pair(table, row, "capture_point"));
    t.zmp.push_back(pair(table, row, "planned_zmp"));
    t.zmp_reference.push_back(
        t.band ? Vec2(0.5 * (pair(table, row, "ref_zmp_min") + pair(table, row, "ref_zmp_max")))
               : pair(table, row, "ref_zmp"));
  }
  return t;
}

Response bounded_response(const std::vector<Vec2>& zmp, double tick) {
  // DCM backwards from where the last reference stays for ever, CoM forwards: the stable ways.
  const std::size_t n = zmp.size();
  Response response{std::vector<Vec2>(n), std::vector<Vec2>(n)};
  response.dcm[n - 1] = zmp[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) {
    response.dcm[i] = engine::dcm_before({tick, zmp[i], zmp[i]}, response.dcm[i + 1], 0.0, omega);
  }
  response.com[0] = zmp[0];
  for (std::size_t i = 0; i + 1 < n; ++i) {
    response.com[i + 1] =
        engine::com_after({tick, zmp[i], zmp[i]}, response.com[i], response.dcm[i], tick, omega);
  }
  return response;
}

TrackingMetrics measure(const Trajectory& t, const std::vector<Band>& bands, double band_tick) {
  TrackingMetrics metrics;
  const std::size_t n = t.zmp.size();
  const Response reference = bounded_response(t.zmp_reference, t.tick);
  Vec2 zmp_square = Vec2::Zero();
  Vec2 com_square = Vec2::Zero();
  std::size_t outside = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double time = static_cast<double>(i) * t.tick;
    zmp_square += (t.zmp[i] - t.zmp_reference[i]).cwiseAbs2();
    com_square += (t.com[i] - reference.com[i]).cwiseAbs2();
    const auto at = static_cast<std::size_t>(std::floor(time / band_tick + 1e-6));
    const Band& band = bands[std::min(at, bands.size() - 1)];
    const double beyond =
        std::max((band.low - t.zmp[i]).maxCoeff(), (t.zmp[i] - band.high).maxCoeff());
    // Printed with six digits.
    constexpr double rounding = 1e-6;
    if (beyond > rounding) {
      ++outside;
      metrics.overshoot = std::max(metrics.overshoot, beyond);
    }
    constexpr double settled = 0.005;
    for (std::size_t kick = 0; kick < walk_kicks.size(); ++kick) {
      const double next = kick + 1 < walk_kicks.size() ? walk_kicks[kick + 1] : walk_end;
      const bool after = time > walk_kicks[kick] - 1e-9 && time < next - 1e-9;
      if (after && (t.dcm[i] - reference.dcm[i]).cwiseAbs().maxCoeff() >= settled) {
        metrics.settling[kick] = time + t.tick - walk_kicks[kick];
      }
    }
  }
  metrics.zmp_rms = (zmp_square / static_cast<double>(n)).cwiseSqrt();
  metrics.com_rms = (com_square / static_cast<double>(n)).cwiseSqrt();
  metrics.outside = static_cast<double>(outside) / static_cast<double>(n);
  return metrics;
}

engine::Parameters walk_parameters(double tick) {
  engine::Parameters p;
  p.tick = tick;
  p.measurement_noise = 1e-10;
  p.foot_half_length = sole.half_length;
  p.foot_half_width = sole.half_width;
  p.lqr_zmp_weight = p.lqr_state_weight[1];
  p.strategies = {.ankle = true, .hip = false, .step = false, .time = false};
  return p;
}

Trajectory walk_with_engine(const engine::Parameters& p) {
  LipmParameters truth;
  truth.sole = sole;
  LipmPlant plant(truth, p.tick);
  engine::WalkingEngine engine(p, plant.measurement());
  const std::array<engine::Footstep, 6> steps{engine::Footstep{{0.2, 0.1}, 0.0, Side::left},
                                              {{0.4, -0.1}, 0.0, Side::right},
                                              {{0.6, 0.1}, 0.0, Side::left},
                                              {{0.8, -0.1}, 0.0, Side::right},
                                              {{0.6, 0.1}, 0.0, Side::left},
                                              {{0.6, -0.1}, 0.0, Side::right}};
  Trajectory t{.name = "engine", .tick = p.tick};
  const auto ticks = static_cast<std::size_t>(std::lround(walk_end / p.tick));
  const auto start = static_cast<std::size_t>(std::lround((walk_first_swing - p.t_init) / p.tick));
  for (std::size_t i = 0; i < ticks; ++i) {
    if (i == start && engine.follow(steps) != engine::WalkingEngine::StepListError::none) {
      throw std::logic_error("the engine does not take the footsteps");
    }
    const engine::WalkingTargets& targets = engine.update(plant.measurement());
    t.com.emplace_back(plant.truth().com.head<2>());
    t.dcm.push_back(plant.dcm());
    t.zmp_reference.push_back(targets.zmp_reference);
    plant.step(targets, {});
    t.zmp.push_back(plant.truth().zmp);
    const double time = static_cast<double>(i) * p.tick;
    if (kicked_between(time, time + p.tick)) {
      const engine::Measurement& now = plant.truth();
      plant.set_state(now.com.head<2>(), now.com_velocity.head<2>() + Vec2(walk_kick, walk_kick));
    }
  }
  return t;
}

Trajectory track(const Trajectory& peer, const std::vector<Band>& bands,
                 const engine::Parameters& p) {
  const Response reference = bounded_response(peer.zmp_reference, peer.tick);
  const engine::DiscreteLipm lipm = engine::discretise(omega, peer.tick);
  engine::Lqg lqg(p);
  Trajectory t{.name = peer.name, .tick = peer.tick, .zmp_reference = peer.zmp_reference};
  Eigen::Matrix2d state = Eigen::Matrix2d::Zero();  // rows CoM, DCM
  for (std::size_t i = 0; i < peer.zmp.size(); ++i) {
    t.com.emplace_back(state.row(0));
    t.dcm.emplace_back(state.row(1));
    lqg.estimate(t.com[i], t.dcm[i]);
    const Band& band = bands[i];
    const std::array<Vec2, 4> corners{band.low, Vec2(band.high.x(), band.low.y()), band.high,
                                      Vec2(band.low.x(), band.high.y())};
    t.zmp.push_back(lqg.control({reference.com[i], reference.dcm[i], peer.zmp_reference[i]},
                                engine::ConvexPolygon(corners), {}, true, true));
    state = (lipm.a * state + lipm.b * t.zmp[i].transpose()).eval();
    const double time = static_cast<double>(i) * peer.tick;
    if (kicked_between(time, time + peer.tick)) state.row(1).array() += walk_kick / omega;
  }
  return t;
}

double least_zmp_rms(double tick) {
  const double growth = std::exp(omega * tick);
  const double jump = walk_kick / omega;
  const double kick_square = jump * jump * tick * (growth + 1.0) / (growth - 1.0);
  return std::sqrt(2.0 * static_cast<double>(walk_kicks.size()) * kick_square / walk_end);
}

TrackingComparison compare_tracking(const std::string& folder) {
  const std::vector<Band> bands = read_band(folder + "/LinearMpcZmp.csv");
  TrackingComparison result;
  std::vector<Trajectory> peers;
  for (const char* name :
       {"DcmTracking", "FootGuidedControl", "PreviewControlZmp", "LinearMpcZmp"}) {
    peers.push_back(read_trajectory(folder + '/' + name + ".csv"));
  }
  const double tick = peers[0].tick;
  for (const Trajectory& peer : peers) {
    result.peers.push_back({peer.name, peer.band, measure(peer, bands, tick),
                            measure(track(peer, bands, walk_parameters(tick)), bands, tick)});
  }
  result.engine = measure(walk_with_engine(walk_parameters(tick)), bands, tick);
  result.engine_2ms = measure(walk_with_engine(walk_parameters(0.002)), bands, tick);
  result.zmp_bound = least_zmp_rms(tick);
  for (const double weight : {1.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 10000.0}) {
    engine::Parameters p = walk_parameters(tick);
    p.lqr_zmp_weight = weight;
    result.sweep.push_back({weight, engine::Lqg(p).feedback_gain()[1],
                            measure(track(peers[0], bands, p), bands, tick)});
  }
  return result;
}

}  // namespace stagger::sim
