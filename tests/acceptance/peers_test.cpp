// Tier 1: the engine beside other programs, on the inputs that they had. Their outputs and where
// they come from: tests/data/peers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "engine/lipm.h"
#include "sim/experiment/peers/step_timing.h"
#include "sim/experiment/peers/tracking.h"

namespace stagger::sim {
namespace {

using engine::Vec2;

const std::string folder = "tests/data/peers";
const std::string step_timing_file = folder + "/step_timing_qp.csv";

void print(const char* who, const StepTimingScore& score) {
  std::printf(
      "  %-20s captures %zu, reserve %.1f mm least %.1f mean, DCM off nominal %.1f mm rms, time "
      "changed by %.1f ms mean\n",
      who, score.captured, 1e3 * score.least_reserve, 1e3 * score.mean_reserve,
      1e3 * score.offset_error_rms, 1e3 * score.mean_time_change);
}

void print(const std::string& who, const TrackingMetrics& m) {
  std::printf(
      "  %-20s ZMP %5.2f (x %5.2f y %5.2f) mm rms, CoM %5.2f (x %5.2f y %5.2f) mm rms, settled "
      "after %.3f %.3f s, outside %.2f %% by %.1f mm\n",
      who.c_str(), 1e3 * m.zmp_rms_both(), 1e3 * m.zmp_rms.x(), 1e3 * m.zmp_rms.y(),
      1e3 * m.com_rms_both(), 1e3 * m.com_rms.x(), 1e3 * m.com_rms.y(), m.settling[0],
      m.settling[1], 1e2 * m.outside, 1e3 * m.overshoot);
}

TEST(LipmPeersStepTiming, TheirDecisionsKeepTheLimitsThatWeUnderstand) {
  const auto cases = read_step_timing(step_timing_file);
  ASSERT_EQ(cases.size(), 1000u);
  for (const StepTimingCase& c : cases) {
    EXPECT_GE(c.walker.reach.polygon(c.stance).margin(c.qp.step), -1e-6);
    EXPECT_GE(c.qp.touchdown, c.earliest - 2e-4);  // that program calculates with 0.1 ms
    EXPECT_LE(c.qp.touchdown, c.walker.t_max);
  }
}

TEST(LipmPeersStepTiming, OursCapturesAllThatTheQuadraticProgrammeDoes) {
  for (const StepTimingComparison& c : compare_step_timing(read_step_timing(step_timing_file))) {
    std::printf("%s: %zu cases, %zu with slack, %zu catchable by anyone\n", c.robot.c_str(),
                c.cases, c.qp_slack, c.catchable);
    print("quadratic programme", c.qp);
    print("ours", c.ours);
    print("ours, every ms", c.closed_loop);
    std::printf("  DCM nearer to nominal: ours in %zu cases, the programme's in %zu\n",
                c.ours_nearer, c.qp_nearer);
    for (const StepTimingStress& stress : c.stress) {
      std::printf("  DCM %.1f times as far: %zu catchable, ours captures %zu\n", stress.scale,
                  stress.catchable, stress.ours);
    }
    EXPECT_EQ(c.cases, 500u);
    EXPECT_EQ(c.both, c.qp.captured);
    EXPECT_EQ(c.both_without_slack, c.qp_captured_without_slack);
    EXPECT_GE(c.ours.captured, c.qp.captured);
    EXPECT_GE(c.ours.least_reserve, c.qp.least_reserve - 1e-6);
    EXPECT_GT(c.ours.mean_reserve, c.qp.mean_reserve);
    EXPECT_LT(c.ours.offset_error_rms, c.qp.offset_error_rms);
    EXPECT_EQ(c.qp_nearer, 0u);
  }
}

TEST(LipmPeersStepTiming, OursCapturesAllThatCanBeCapturedAtAll) {
  for (const StepTimingComparison& c : compare_step_timing(read_step_timing(step_timing_file))) {
    EXPECT_EQ(c.ours.captured, c.catchable);
    EXPECT_EQ(c.disagreements, 0u);
    EXPECT_EQ(c.decisions, c.cases * (3 + c.stress.size()));
    for (const StepTimingStress& stress : c.stress) {
      EXPECT_EQ(stress.ours, stress.catchable) << c.robot << ' ' << stress.scale;
    }
    EXPECT_LT(c.stress.back().catchable, c.cases / 2);
  }
}

TEST(LipmPeersStepTiming, DecidingAnewEveryMillisecondChangesNothing) {
  for (const StepTimingComparison& c : compare_step_timing(read_step_timing(step_timing_file))) {
    EXPECT_EQ(c.closed_loop.captured, c.ours.captured);
    EXPECT_LT(c.step_difference, 1e-9);
    EXPECT_LT(c.time_difference, 1e-9);
  }
}

TEST(LipmPeersTracking, TheirTrajectoriesAreThePendulumAndTheKicksThatWeUnderstand) {
  const double omega = std::sqrt(9.81);
  for (const char* name :
       {"DcmTracking", "FootGuidedControl", "PreviewControlZmp", "LinearMpcZmp"}) {
    const Trajectory t = read_trajectory(folder + '/' + name + ".csv");
    ASSERT_EQ(t.zmp.size(), 2000u);
    EXPECT_EQ(t.tick, 0.005);
    for (std::size_t i = 0; i + 1 < t.zmp.size(); ++i) {
      const Vec2 kick = t.dcm[i + 1] - engine::dcm_after(t.dcm[i], t.zmp[i], t.tick, omega);
      const bool kicked = i + 1 == 901 || i + 1 == 1701;
      const double expected = kicked ? walk_kick / omega : 0.0;
      // The files have six digits.
      EXPECT_LT((kick - Vec2(expected, expected)).norm(), 5e-6) << name << ' ' << i;
    }
  }
}

TEST(LipmPeersTracking, OursIsNearerToTheReferenceThanEachOther) {
  const TrackingComparison c = compare_tracking(folder);
  std::printf("no controller: ZMP below about %.2f mm rms\n", 1e3 * c.zmp_bound);
  ASSERT_EQ(c.peers.size(), 4u);
  for (const PeerTracking& peer : c.peers) {
    std::printf("%s%s\n", peer.name.c_str(), peer.band ? " (knows limits only)" : "");
    print("it", peer.peer);
    print("ours", peer.ours);
    for (const TrackingMetrics* ours : {&peer.ours, &c.engine, &c.engine_2ms}) {
      EXPECT_LT(ours->zmp_rms_both(), peer.peer.zmp_rms_both());
      EXPECT_LT(ours->com_rms_both(), peer.peer.com_rms_both());
      EXPECT_LT(ours->settling[0], peer.peer.settling[0]);
      EXPECT_LT(ours->settling[1], peer.peer.settling[1]);
      EXPECT_EQ(ours->outside, 0.0);
    }
  }
  print("engine", c.engine);
  print("engine, 2 ms", c.engine_2ms);
}

TEST(LipmPeersTracking, OursIsNearlyTheCheapestWayBack) {
  const TrackingComparison c = compare_tracking(folder);
  EXPECT_LT(c.peers[0].ours.zmp_rms_both(), 1.02 * c.zmp_bound);
  for (const PeerTracking& peer : c.peers) EXPECT_GT(peer.peer.zmp_rms_both(), c.zmp_bound);
  // A dearer ZMP trades the error of the CoM for that of the ZMP; none gets below the bound.
  double com = 0.0;
  for (const WeightedTracking& point : c.sweep) {
    char name[48];
    std::snprintf(name, sizeof name, "R %.0f, K %.2f", point.zmp_weight, point.dcm_gain);
    print(name, point.metrics);
    EXPECT_GT(point.metrics.zmp_rms_both(), 0.995 * c.zmp_bound);
    EXPECT_GT(point.metrics.com_rms_both(), com);
    com = point.metrics.com_rms_both();
  }
}

}  // namespace
}  // namespace stagger::sim
