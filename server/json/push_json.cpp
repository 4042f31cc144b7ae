#include "server/json/push_json.h"

#include <numbers>

namespace stagger::server {
namespace {

using sim::Range;

// Takes a robot of 30 kg to more than 6 m/s: far beyond what any step can catch. [N s]
constexpr double max_impulse = 200.0;
constexpr double max_force = 20000.0;  // [N]; 200 N s within the shortest duration is 200 kN

Range impulse_range() { return Range::more_than_up_to(0.0, max_impulse, "N s"); }

sim::Vec3 read_direction(sim::JsonReader& reader) {
  const auto degrees =
      reader.optional_number("direction_deg", Range::between(-360.0, 360.0, "degrees"));
  const auto vector = reader.optional_vec3("direction", Range::between(-1e6, 1e6));
  if (degrees && vector) {
    reader.refuse("direction", "cannot be given together with direction_deg");
  } else if (degrees) {
    return sim::horizontal_direction(*degrees);
  } else if (vector) {
    const double length = vector->norm();
    if (length < 1e-9) {
      reader.refuse("direction", "has no length");
    } else if (std::abs(length - 1.0) < 1e-15) {
      return *vector;  // a resolved push comes back: dividing again would change its last bits
    } else {
      return *vector / length;
    }
  }
  return sim::Vec3::UnitX();
}

// Impulse of a unit of peak force in a unit of time.
double mean_of_peak(sim::PushProfile profile) {
  return profile == sim::PushProfile::half_sine ? 2.0 / std::numbers::pi : 1.0;
}

double read_impulse(sim::JsonReader& reader, double duration_s, sim::PushProfile profile) {
  if (reader.has("impulse_ns") && reader.has("force_n")) {
    reader.refuse("force_n", "cannot be given together with impulse_ns");
  }
  const auto force = reader.optional_number("force_n", Range::more_than_up_to(0.0, max_force, "N"));
  if (!reader.has("force_n")) return reader.number("impulse_ns", impulse_range());
  // Asked for all the same, so that it counts as a known field.
  reader.optional_number("impulse_ns", impulse_range());
  const double impulse = force.value_or(0.0) * duration_s * mean_of_peak(profile);
  if (impulse > max_impulse) {
    reader.refuse("force_n", "gives an impulse of " + Json(impulse).dump() +
                                 " N s over duration_s; allowed: " + impulse_range().text());
  }
  return impulse;
}

sim::PhaseTrigger read_phase(sim::JsonReader& reader) {
  using engine::WalkingState;
  sim::PhaseTrigger trigger;
  trigger.phase =
      reader.one_of<WalkingState>("phase", {{"single_support", WalkingState::single_support},
                                            {"double_support", WalkingState::double_support}});
  trigger.leg = reader.optional_one_of<sim::Side>(
      "leg", {{"left", sim::Side::left}, {"right", sim::Side::right}});
  trigger.fraction =
      reader.number_or("fraction", 0.0, Range::from_to_below(0.0, 1.0, "of the phase"));
  return trigger;
}

sim::PushTrigger read_trigger(sim::JsonReader& reader) {
  sim::PhaseTrigger phase;
  const bool by_phase = reader.optional_object(
      "trigger", [&phase](sim::JsonReader& trigger) { phase = read_phase(trigger); });
  const auto at = reader.optional_number("at_s", Range::between(0.0, 1e6, "s"));
  if (by_phase && at) reader.refuse("at_s", "cannot be given together with trigger");
  if (by_phase) return phase;
  if (at) return sim::TimeTrigger{*at};
  return sim::Immediate{};
}

Json vector_json(const sim::Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

std::string_view state_name(sim::PushState state) {
  switch (state) {
    case sim::PushState::scheduled:
      return "scheduled";
    case sim::PushState::active:
      return "active";
    case sim::PushState::done:
      return "done";
    case sim::PushState::cancelled:
      return "cancelled";
  }
  return "scheduled";
}

}  // namespace

sim::PushSpec read_push(sim::JsonReader& reader) {
  sim::PushSpec push;
  push.link = reader.string_or("link", {});
  push.point = reader.optional_vec3("point", Range::between(-10.0, 10.0, "m"));
  push.direction = read_direction(reader);
  push.duration_s =
      reader.number_or("duration_s", push.duration_s, Range::between(0.001, 2.0, "s"));
  push.profile = reader.one_of_or<sim::PushProfile>(
      "profile", push.profile,
      {{"rectangular", sim::PushProfile::rectangular}, {"half_sine", sim::PushProfile::half_sine}});
  push.impulse_ns = read_impulse(reader, push.duration_s, push.profile);
  push.trigger = read_trigger(reader);
  return push;
}

Json push_spec_json(const sim::PushSpec& push) {
  Json json;
  if (!push.link.empty()) json["link"] = push.link;
  if (push.point) json["point"] = vector_json(*push.point);
  json["direction"] = vector_json(push.direction);
  json["impulse_ns"] = push.impulse_ns;
  json["duration_s"] = push.duration_s;
  json["profile"] = push.profile == sim::PushProfile::half_sine ? "half_sine" : "rectangular";
  if (const auto* at = std::get_if<sim::TimeTrigger>(&push.trigger)) {
    json["at_s"] = at->at_s;
  } else if (const auto* phase = std::get_if<sim::PhaseTrigger>(&push.trigger)) {
    Json trigger;
    const bool single = phase->phase == engine::WalkingState::single_support;
    trigger["phase"] = single ? "single_support" : "double_support";
    if (phase->leg) trigger["leg"] = *phase->leg == sim::Side::left ? "left" : "right";
    trigger["fraction"] = phase->fraction;
    json["trigger"] = std::move(trigger);
  }
  return json;
}

Json push_record_json(const sim::PushRecord& record, double tick_s) {
  return {{"id", record.id},
          {"state", state_name(record.state)},
          {"tick", record.created_tick},
          {"time_s", static_cast<double>(record.created_tick) * tick_s},
          {"start_tick", or_null(record.start_tick)},
          {"end_tick", or_null(record.end_tick)},
          {"spec", push_spec_json(record.spec)},
          {"delivered_ns", vector_json(record.delivered)}};
}

}  // namespace stagger::server
