// A controller on a robot may not take memory, throw or lock while it runs.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <mutex>
#include <new>
#include <ostream>
#include <random>

#include "engine/footstep_planner.h"
#include "engine/walking_engine.h"
#include "tests/engine/call_counts.h"
#include "tests/engine/integrate.h"

#ifdef STAGGER_CALLS_ARE_COUNTED

namespace stagger::testing {

// Prints itself in a failed expectation.
void PrintTo(const CallCounts& c, std::ostream* out) {
  *out << c.allocations << " allocations, " << c.frees << " frees, " << c.throws << " throws, "
       << c.locks << " locks";
}

}  // namespace stagger::testing

namespace stagger::engine {
namespace {

using testing::call_counts;
using testing::CallCounts;

/// The calls that `something` makes.
template <typename Something>
CallCounts calls_of(const Something& something) {
  const CallCounts before = call_counts();
  something();
  const CallCounts after = call_counts();
  return {after.allocations - before.allocations, after.frees - before.frees,
          after.throws - before.throws, after.locks - before.locks};
}

TEST(CallCounts, SeeEveryWayToTakeMemory) {
  struct alignas(64) Aligned {
    double value;
  };
  struct Way {
    const char* name;
    void (*take_and_free)();
  };
  // Pointers are volatile, or the compiler leaves both calls out.
  constexpr std::array ways{
      Way{"new",
          [] {
            int* volatile p = new int(1);
            delete p;
          }},
      Way{"new[]",
          [] {
            int* volatile p = new int[7];
            delete[] p;
          }},
      Way{"new (nothrow)",
          [] {
            int* volatile p = new (std::nothrow) int(1);
            delete p;
          }},
      Way{"aligned new",
          [] {
            Aligned* volatile p = new Aligned();
            delete p;
          }},
      Way{"aligned new[]",
          [] {
            Aligned* volatile p = new Aligned[3];
            delete[] p;
          }},
      Way{"malloc",
          [] {
            void* volatile p = std::malloc(8);
            std::free(p);
          }},
      Way{"calloc",
          [] {
            void* volatile p = std::calloc(8, 8);
            std::free(p);
          }},
      Way{"realloc",
          [] {
            void* volatile p = std::realloc(nullptr, 8);
            std::free(p);
          }},
      Way{"aligned_alloc",
          [] {
            void* volatile p = std::aligned_alloc(64, 64);
            std::free(p);
          }},
      Way{"posix_memalign",
          [] {
            void* p = nullptr;
            if (posix_memalign(&p, 64, 64) == 0) std::free(p);
          }},
      Way{"a matrix of no fixed size",
          [] {
            const volatile Eigen::Index size = 5;
            Eigen::VectorXd(size).setZero();
          }},
  };
  for (const Way& way : ways) {
    EXPECT_EQ(calls_of(way.take_and_free), (CallCounts{1, 1, 0, 0})) << way.name;
  }
}

TEST(CallCounts, SeeThrowsAndLocks) {
  EXPECT_EQ(calls_of([] {
              try {
                throw 1;
              } catch (int) {
              }
            }).throws,
            1U);
  std::mutex mutex;
  EXPECT_EQ(calls_of([&] { const std::lock_guard lock(mutex); }).locks, 1U);
}

/// Walks and is pushed for ten seconds, stops, takes a list of steps, stands, and begins anew:
/// whatever the door of the engine offers, with noise on what is measured.
class Everything {
 public:
  static constexpr int round = 20000;  ///< ticks

  Everything() : engine_(parameters(), start()) {}

  void tick(int i) {
    const int time = i % round;
    toggle(i);
    command(i, time);
    // Never while strategies are off: then it may have nothing left to catch itself with.
    if (time % 1500 == 700) mass_.velocity += pushes_[static_cast<std::size_t>(i / 1500) % 4];
    measure();
    const WalkingTargets& t = engine_.update(measurement_);
    move(t);

    worst_ = std::max(worst_, (mass_.dcm(omega_) - t.dcm_reference).norm());
    hip_ticks_ += t.zmp_shift.norm() > 0.1 ? 1 : 0;
    moved_steps_ += t.planned_step.position != t.adjusted_step.position ? 1 : 0;
  }

  const WalkingEngine& engine() const { return engine_; }
  int lists() const { return lists_; }
  int changes() const { return changes_; }      ///< of the parameters
  int refusals() const { return refusals_; }    ///< of lists that no leg can walk
  int hip_ticks() const { return hip_ticks_; }  ///< with half of the torque or more
  int moved_steps() const { return moved_steps_; }
  double worst() const { return worst_; }  ///< worst error of the DCM [m]

 private:
  static Parameters parameters() {
    Parameters p;
    p.tick = 0.001;
    p.t_ss = 0.4;
    p.t_ds = 0.1;
    p.measurement_noise = 1e-6;
    p.step_margin = 0.01;
    p.hip.torque = 60.0;
    return p;
  }

  static Tuning slower() {
    Parameters p = parameters();
    p.t_ss = 0.5;
    p.lqr_zmp_weight = 20.0;
    return Tuning(p);
  }

  Measurement start() {
    measurement_.com = {0.0, 0.0, parameters().com_height};
    measurement_.feet[0].position = {0.0, 0.1, 0.0};
    measurement_.feet[1].position = {0.0, -0.1, 0.0};
    return measurement_;
  }

  /// Every second, for 50 ms, another of the sixteen ways to have the four switched on and off.
  void toggle(int i) {
    const int way = i % 1000 < 50 ? i / 1000 % 16 : 15;
    engine_.set_strategies({(way & 1) != 0, (way & 2) != 0, (way & 4) != 0, (way & 8) != 0});
  }

  void command(int i, int time) {
    if (time == 0 || time == 4000 || time == 8000) {
      engine_.walk(commands_[static_cast<std::size_t>(i / 4000) % 4]);
    } else if (time == 5000 || time == 12500) {  // in mid-walk, and standing
      changes_ += engine_.change(tunings_[static_cast<std::size_t>(changes_) % 2]) ? 1 : 0;
    } else if (time == 9000) {
      engine_.stop();
    } else if (time == 9200) {  // before it has come to rest
      engine_.walk(commands_[0]);
    } else if (time == 10500) {
      engine_.stop();
    } else if (time == 15000) {
      follow();
    }
  }

  void follow() {
    std::array<Footstep, 5> steps;
    const StepPattern pattern =
        step_pattern({0.1, 0.0, 0.1}, engine_.reach(), engine_.parameters());
    Footstep from{measurement_.feet[0].position.head<2>(), measurement_.feet[0].yaw, Side::left};
    for (Footstep& step : steps) {
      step = next_footstep(from, pattern);
      from = step;
    }
    Footstep far = steps[0];
    far.position.x() += 5.0;
    using Error = WalkingEngine::StepListError;
    refusals_ += engine_.follow({&far, 1}) == Error::out_of_reach ? 1 : 0;
    lists_ += engine_.follow(steps) == Error::none ? 1 : 0;
  }

  void measure() {
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      measurement_.com[axis] = mass_.com[axis] + noise_(random_);
      measurement_.com_velocity[axis] = mass_.velocity[axis] + omega_ * noise_(random_);
    }
  }

  void move(const WalkingTargets& t) {
    const double tick = parameters().tick;
    const Vec2 acceleration = omega_ * omega_ * (mass_.com - t.zmp_command - t.zmp_shift);
    mass_.com += tick * mass_.velocity + 0.5 * tick * tick * acceleration;
    mass_.velocity += tick * acceleration;
    for (std::size_t foot = 0; foot < 2; ++foot) {
      if (!t.feet[foot].in_contact) {
        measurement_.feet[foot] = {t.feet[foot].position, t.feet[foot].yaw};
      }
      measurement_.foot_load[foot] = measurement_.feet[foot].position.z() <= 0.0 ? 150.0 : 0.0;
    }
  }

  const std::array<WalkCommand, 4> commands_{WalkCommand{}, WalkCommand{0.3, 0.0, 0.0},
                                             WalkCommand{0.0, -0.1, 0.3},
                                             WalkCommand{-0.2, 0.1, 0.0}};
  const std::array<Vec2, 4> pushes_{Vec2(0.15, 0.1), Vec2(-0.15, -0.1), Vec2(0.2, -0.05),
                                    Vec2(-0.2, 0.05)};
  double omega_ = natural_frequency(parameters());
  Measurement measurement_;
  WalkingEngine engine_;
  const std::array<Tuning, 2> tunings_{slower(), Tuning(parameters())};
  testing::PointMass mass_;
  std::mt19937 random_{1};
  std::normal_distribution<double> noise_{0.0, 1e-3};
  int lists_ = 0;
  int refusals_ = 0;
  int changes_ = 0;
  int hip_ticks_ = 0;
  int moved_steps_ = 0;
  double worst_ = 0.0;
};

TEST(Allocation, NoHeapThrowOrLockInAHundredThousandTicks) {
  constexpr int rounds = 5;
  Everything robot;
  const CallCounts calls = calls_of([&] {
    for (int i = 0; i < rounds * Everything::round; ++i) robot.tick(i);
  });
  EXPECT_EQ(calls, CallCounts());
  // The engine did work all the while: everything was used, and it is still up.
  EXPECT_EQ(robot.lists(), rounds);
  EXPECT_EQ(robot.refusals(), rounds);
  EXPECT_EQ(robot.changes(), 2 * rounds);
  EXPECT_FALSE(robot.engine().change_waits());
  EXPECT_GT(robot.hip_ticks(), 100);
  EXPECT_GT(robot.moved_steps(), 1000);
  EXPECT_GT(robot.engine().targets().step_count, 100U);
  EXPECT_EQ(robot.engine().targets().state, WalkingState::idle);
  EXPECT_LT(robot.worst(), 0.3);
}

}  // namespace
}  // namespace stagger::engine

#endif
