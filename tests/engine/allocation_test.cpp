// A controller on a robot may not take memory while it runs. The sanitizers bring allocators of
// their own, so they leave this one out.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "engine/walking_engine.h"
#include "tests/engine/integrate.h"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {
std::size_t allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace stagger::engine {
namespace {

TEST(Allocation, IsCounted) {
  const std::size_t before = allocations;
  int* volatile number = new int(1);  // volatile: or the compiler leaves both calls out
  delete number;
  EXPECT_EQ(allocations, before + 1);
}

TEST(Allocation, NoneInAHundredThousandTicks) {
  Parameters p;
  p.tick = 0.001;
  p.t_ss = 0.4;
  p.t_ds = 0.1;
  p.measurement_noise = 1e-8;
  p.step_margin = 0.01;
  p.hip.torque = 60.0;
  const double omega = natural_frequency(p);
  Measurement measurement;
  measurement.com = {0.0, 0.0, p.com_height};
  measurement.feet[0].position = {0.0, 0.1, 0.0};
  measurement.feet[1].position = {0.0, -0.1, 0.0};
  WalkingEngine engine(p, measurement);
  testing::PointMass mass;
  const std::array<WalkCommand, 4> commands{WalkCommand{}, WalkCommand{0.3, 0.0, 0.0},
                                            WalkCommand{0.0, -0.1, 0.3},
                                            WalkCommand{-0.2, 0.1, 0.0}};
  const double dt2 = 0.5 * p.tick * p.tick;

  const std::size_t before = allocations;
  for (int i = 0; i < 100000; ++i) {
    if (i % 7000 == 0) engine.walk(commands[static_cast<std::size_t>(i / 7000) % 4]);
    if (i % 31000 == 30000) engine.stop();
    if (i % 5003 == 5002) mass.velocity += Vec2(0.15, i % 2 == 0 ? 0.1 : -0.1);
    measurement.com.head<2>() = mass.com;
    measurement.com_velocity.head<2>() = mass.velocity;
    const WalkingTargets& t = engine.update(measurement);
    const Vec2 acceleration = omega * omega * (mass.com - t.zmp_command - t.zmp_shift);
    mass.com += p.tick * mass.velocity + dt2 * acceleration;
    mass.velocity += p.tick * acceleration;
    for (std::size_t foot = 0; foot < 2; ++foot) {
      if (!t.feet[foot].in_contact) {
        measurement.feet[foot] = {t.feet[foot].position, t.feet[foot].yaw};
      }
      measurement.foot_load[foot] = measurement.feet[foot].position.z() <= 0.0 ? 150.0 : 0.0;
    }
  }
  EXPECT_EQ(allocations, before);
  // The engine did work all the while: it walked, was pushed, and is still up.
  EXPECT_GT(engine.targets().step_count, 150U);
  EXPECT_LT((mass.dcm(omega) - engine.targets().dcm_reference).norm(), 0.2);
}

}  // namespace
}  // namespace stagger::engine

#endif
