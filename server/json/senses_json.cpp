#include "server/json/senses_json.h"

#include <cmath>

namespace stagger::server {
namespace {

constexpr double ms_per_s = 1000.0;
static_assert(max_control_delay_ms <= ms_per_s * sim::max_control_delay);

const sim::Names<bool>& perfect_by_state() {
  static const sim::Names<bool> names{{"estimated", false}, {"perfect", true}};
  return names;
}

}  // namespace

sim::SenseParameters read_senses(sim::JsonReader& reader, const sim::SenseParameters& otherwise) {
  sim::SenseParameters senses = otherwise;
  senses.perfect_state = reader.one_of_or("state", senses.perfect_state, perfect_by_state());
  const auto delay = reader.optional_integer("control_delay_ms",
                                             sim::Range::between(0, max_control_delay_ms, "ms"));
  if (delay) set_control_delay_ms(senses, *delay);
  return senses;
}

std::string_view name_of_state(const sim::SenseParameters& senses) {
  return perfect_by_state()[senses.perfect_state ? 1 : 0].first;
}

bool is_perfect_state(std::string_view name) { return name == perfect_by_state()[1].first; }

std::int64_t control_delay_ms(const sim::SenseParameters& senses) {
  return std::llround(ms_per_s * senses.control_delay);
}

void set_control_delay_ms(sim::SenseParameters& senses, std::int64_t ms) {
  senses.control_delay = static_cast<double>(ms) / ms_per_s;
}

void write_senses(Json& json, sim::PlantKind plant, const sim::SenseParameters& senses) {
  const bool senses_apply = plant == sim::PlantKind::bullet;
  json["state"] = senses_apply ? Json(name_of_state(senses)) : Json(nullptr);
  json["control_delay_ms"] = senses_apply ? Json(control_delay_ms(senses)) : Json(nullptr);
}

}  // namespace stagger::server
