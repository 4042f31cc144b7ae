#include "server/report/limits_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "server/json/limits_json.h"

namespace stagger::server {
namespace {

/// At most so many digits behind the point, without zeros at the end.
std::string number(double value, int digits) {
  std::ostringstream out;
  out.setf(std::ios::fixed);
  out.precision(digits);
  out << value;
  std::string text = out.str();
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string number(const Json& value, int digits) {
  return value.is_number() ? number(value.get<double>(), digits) : "-";
}

std::string phase_text(const Json& phase) {
  return phase.is_string() ? phase.get<std::string>() : number(phase, 3);
}

template <std::size_t N>
std::string aligned(const std::vector<std::array<std::string, N>>& rows) {
  std::array<std::size_t, N> widths{};
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < N; ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::ostringstream out;
  for (const auto& row : rows) {
    // Numbers to the right, the note at the end as it is.
    for (std::size_t i = 0; i + 1 < N; ++i) {
      out << std::string(widths[i] - row[i].size(), ' ') << row[i] << "  ";
    }
    out << row[N - 1] << '\n';
  }
  return out.str();
}

/// What the pushes can do, told by the greatest rung: nothing fell up to there.
std::string limit_text(const Json& result) {
  if (result["pass_dv"].is_null()) return "< " + number(result["fail_dv"], 3);
  std::string text = result["fail_dv"].is_null() ? ">= " : "";
  text += number(result["pass_dv"], 3);
  if (!result["ceiling_percent"].is_null()) {
    text += " (" + number(result["ceiling_percent"], 0) + " %)";
  }
  return text;
}

template <typename T>
void add_once(std::vector<T>& list, const T& value) {
  if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

std::string listed(const Json& names) {
  std::string text;
  for (const Json& name : names) text += (text.empty() ? "" : ", ") + name.get<std::string>();
  return text.empty() ? "none" : text;
}

}  // namespace

std::string limits_columns(const sim::LimitsSpec& spec, const std::vector<sim::Limit>& limits,
                           const sim::Robot& robot) {
  std::vector<std::array<std::string, 9>> rows{{"direction", "phase", "push", "passes", "fails",
                                                "impulse", "Fr", "of ceiling", " why it fails"},
                                               {"deg", "", "s", "m/s", "m/s", "N s", "", "%", ""}};
  const Json json = limits_json(spec, limits, robot);
  for (const Json& r : json["results"]) {
    rows.push_back({number(r["direction_deg"], 1), phase_text(r["phase"]),
                    number(r["duration_s"], 3), number(r["pass_dv"], 3), number(r["fail_dv"], 3),
                    number(r["pass_ns"], 2), number(r["fr"], 3), number(r["ceiling_percent"], 0),
                    " " + r["fail_reason"].get<std::string>()});
  }
  std::string text = aligned(rows);
  // Lines without a note must not end in blanks.
  for (std::size_t i = text.find(" \n"); i != std::string::npos; i = text.find(" \n")) {
    text.erase(i, 1);
  }
  return text;
}

std::string limits_markdown(const sim::LimitsSpec& spec, const std::vector<sim::Limit>& limits,
                            const sim::Robot& robot, const std::string& command,
                            const std::string& date) {
  const Json json = limits_json(spec, limits, robot);
  const Json& conditions = json["conditions"];
  std::vector<double> durations;
  std::vector<Json> phases;
  std::vector<double> directions;
  for (const Json& result : json["results"]) {
    add_once(durations, result["duration_s"].get<double>());
    add_once(phases, result["phase"]);
    add_once(directions, result["direction_deg"].get<double>());
  }

  std::ostringstream out;
  out << "# Push limits of " << spec.trial.robot << "\n\n"
      << "Made on " << date << " by version " << STAGGER_VERSION << " with\n\n    " << command
      << "\n\nGreatest delta-v [m/s] that passes, and in brackets its share of the ceiling of the "
         "pendulum.\nWhat that means: [limits.md](../limits.md).\n\n"
      << "| condition | |\n| --- | --- |\n"
      << "| robot | " << number(conditions["mass_kg"], 2) << " kg, CoM at "
      << number(conditions["com_height_m"], 3) << " m, on `"
      << conditions["plant"].get<std::string>() << "` |\n| steps | "
      << number(conditions["t_ss_s"], 3) << " s single + " << number(conditions["t_ds_s"], 3)
      << " s double support |\n| strategies | " << listed(conditions["strategies"])
      << " |\n| phase | share of the single support on the " << conditions["leg"].get<std::string>()
      << " leg that has passed |\n| push | at the centre of "
      << "mass of `" << conditions["push"]["link"].get<std::string>() << "` |\n| rungs | "
      << number(spec.rungs.front(), 3) << " to " << number(spec.rungs.back(), 3) << " m/s, "
      << spec.rungs.size() << " of them |\n| seeds | " << spec.seeds.size()
      << " |\n| all conditions | `" << conditions.dump() << "` |\n";
  for (const double duration : durations) {
    out << "\n## Push of " << number(duration, 3) << " s\n\n| direction |";
    for (const Json& phase : phases) out << ' ' << phase_text(phase) << " |";
    out << "\n| --- |";
    for (std::size_t i = 0; i < phases.size(); ++i) out << " --- |";
    for (const double direction : directions) {
      out << "\n| " << number(direction, 1) << "° |";
      for (const Json& phase : phases) {
        for (const Json& r : json["results"]) {
          if (r["duration_s"] == duration && r["phase"] == phase &&
              r["direction_deg"] == direction) {
            out << ' ' << limit_text(r) << " |";
          }
        }
      }
    }
    out << '\n';
  }
  return out.str();
}

}  // namespace stagger::server
