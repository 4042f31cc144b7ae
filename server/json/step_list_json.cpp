#include "server/json/step_list_json.h"

#include <numbers>

namespace stagger::server {
namespace {

using sim::Range;

// A robot that has walked farther than that has walked for weeks. [m]
constexpr double farthest = 1e6;

sim::Footstep read_step(sim::JsonReader& reader) {
  sim::Footstep step;
  step.side =
      reader.one_of<sim::Side>("side", {{"left", sim::Side::left}, {"right", sim::Side::right}});
  step.position.x() = reader.number("x", Range::between(-farthest, farthest, "m"));
  step.position.y() = reader.number("y", Range::between(-farthest, farthest, "m"));
  const auto degrees = reader.optional_number("yaw_deg", Range::between(-360.0, 360.0, "degrees"));
  const auto radians = reader.optional_number("yaw", Range::between(-1e3, 1e3, "rad"));
  if (degrees && radians) reader.refuse("yaw", "cannot be given together with yaw_deg");
  step.yaw = radians.value_or(degrees.value_or(0.0) * std::numbers::pi / 180.0);
  return step;
}

}  // namespace

std::vector<sim::Footstep> read_steps(sim::JsonReader& reader) {
  std::vector<sim::Footstep> steps;
  reader.object_list("steps", Range::between(1, engine::WalkingEngine::max_listed_steps),
                     [&](sim::JsonReader& step) { steps.push_back(read_step(step)); });
  return steps;
}

Json steps_json(const std::vector<sim::Footstep>& steps) {
  Json list = Json::array();
  for (const sim::Footstep& step : steps) {
    list.push_back({{"side", step.side == sim::Side::left ? "left" : "right"},
                    {"x", step.position.x()},
                    {"y", step.position.y()},
                    {"yaw", step.yaw}});
  }
  return list;
}

std::optional<StepList> read_step_list(sim::JsonReader& reader) {
  if (reader.value("steps") == nullptr) return std::nullopt;
  StepList list;
  list.steps = read_steps(reader);
  list.frame = reader.one_of_or<StepFrame>(
      "frame", list.frame, {{"world", StepFrame::world}, {"robot", StepFrame::robot}});
  return list;
}

}  // namespace stagger::server
