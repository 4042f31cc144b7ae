#include "server/campaign/spec.h"

#include <algorithm>
#include <cmath>

namespace stagger::server::campaign {
namespace {

using nlohmann::json;
using sim::JsonReader;
using sim::Range;

constexpr double max_repeats = 1e6;
constexpr double max_values = 10'000;   ///< of one factor
constexpr double max_entries = 10'000;  ///< of a list
constexpr double max_levels = 10'000;   ///< of a bisection
constexpr double max_campaign = 1e9;    ///< trials
constexpr double max_seed = 9007199254740992.0;
constexpr std::size_t max_path = 100;

/// A step of 0.1 ten times over has to end at 1: to 12 digits.
double decimal(double value) {
  constexpr double digits = 1e12;
  return std::abs(value) < 1e3 ? std::round(value * digits) / digits : value;
}

/// Fit to name a folder.
bool is_name(const std::string& name) {
  return name.front() != '.' && std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '-' || c == '_' || c == '.';
         });
}

bool is_path(const std::string& path) {
  if (path.empty() || path.size() > max_path) return false;
  const std::vector<std::string> steps = path_steps(path);
  return std::all_of(steps.begin(), steps.end(), [](const std::string& step) {
    return !step.empty() && step.find_first_of("/~ \"") == std::string::npos;
  });
}

void check_path(JsonReader& in, const std::string& name, const std::string& path) {
  if (is_path(path)) return;
  in.refuse(name,
            "is no path; allowed: names of the trial's fields with dots between them, as "
            "push.trigger.fraction");
}

/// [from, to, count]: count numbers, both ends among them.
std::vector<json> spaced(JsonReader& in, const std::string& name, bool logarithmic) {
  const Range range = logarithmic ? Range::more_than(0.0) : Range::any();
  const std::vector<double> given = in.number_list(name, range, Range::between(3, 3));
  if (given.size() != 3) return {};
  const double count = given[2];
  if (count != std::floor(count) || count < 2 || count > max_values) {
    in.refuse(name, "asks for " + json(count).dump() + " numbers; allowed: 2 to 10000");
    return {};
  }
  std::vector<json> values;
  values.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const double share = i / (count - 1.0);
    const double value = logarithmic ? given[0] * std::pow(given[1] / given[0], share)
                                     : given[0] + (given[1] - given[0]) * share;
    values.emplace_back(decimal(value));
  }
  return values;
}

/// [from, to, step]: `to` too when a step meets it.
std::vector<json> stepped(JsonReader& in, const std::string& name) {
  const std::vector<double> given = in.number_list(name, Range::any(), Range::between(3, 3));
  if (given.size() != 3) return {};
  const double count = std::floor((given[1] - given[0]) / given[2] + 1e-9) + 1.0;
  if (!(count >= 1.0 && count <= max_values)) {
    in.refuse(name, "makes no 1 to 10000 numbers from the first to the second by the third");
    return {};
  }
  std::vector<json> values;
  values.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < static_cast<int>(count); ++i) {
    values.emplace_back(decimal(given[0] + i * given[2]));
  }
  return values;
}

std::optional<Interval> read_interval(JsonReader& in, const std::string& name, bool logarithmic) {
  const Range range = logarithmic ? Range::more_than(0.0) : Range::any();
  const std::vector<double> given = in.number_list(name, range, Range::between(2, 2));
  if (given.size() != 2) return std::nullopt;
  if (!(given[0] < given[1])) {
    in.refuse(name, "does not go up; allowed: [least, greatest]");
    return std::nullopt;
  }
  return Interval{given[0], given[1], logarithmic};
}

void read_made_values(JsonReader& in, Factor& factor, bool random) {
  const std::vector<std::string> ways{"linspace", "logspace", "range", "uniform", "log_uniform"};
  std::size_t given = 0;
  for (const std::string& way : ways) {
    if (in.has(way)) ++given;
    // Asked for, so that it counts as a known field.
    if (in.value(way) == nullptr) continue;
    if (way == "range") {
      factor.values = stepped(in, way);
    } else if (way.ends_with("space")) {
      factor.values = spaced(in, way, way == "logspace");
    } else {
      factor.interval = read_interval(in, way, way == "log_uniform");
      if (!random) in.refuse(way, "is for designs of kind random");
    }
  }
  if (given != 1) {
    const std::string pointer = in.pointer("");
    in.errors().add(pointer.substr(0, pointer.size() - 1),
                    "takes one of linspace, logspace, range, uniform, log_uniform");
  }
}

Factor read_factor(JsonReader& in, const std::string& path, bool random) {
  Factor factor;
  factor.path = path;
  check_path(in, path, path);
  const json* value = in.value(path);
  if (value->is_object()) {
    in.object(path, [&](JsonReader& made) { read_made_values(made, factor, random); });
  } else if (value->is_array() && !value->empty() &&
             static_cast<double>(value->size()) <= max_values) {
    factor.values = value->get<std::vector<json>>();
    factor.listed = true;
  } else {
    in.refuse(path,
              "is no set of values; allowed: an array of 1 to 10000 values, or an object as "
              R"({"linspace":[0,345,24]})");
  }
  return factor;
}

std::vector<Setting> read_settings(JsonReader& in, const json& object) {
  std::vector<Setting> settings;
  for (const auto& [path, value] : object.items()) {
    check_path(in, path, path);
    in.value(path);
    settings.emplace_back(path, value);
  }
  return settings;
}

std::vector<Entry> read_entries(JsonReader& in) {
  std::vector<Entry> entries;
  in.object_list("trials", Range::between(1, max_entries), [&](JsonReader& entry) {
    Entry read;
    read.name = entry.string("name");
    const json* set = entry.value("set");
    entry.object("set", [&](JsonReader& paths) { read.settings = read_settings(paths, *set); });
    const bool again = std::any_of(entries.begin(), entries.end(),
                                   [&](const Entry& other) { return other.name == read.name; });
    if (again) entry.refuse("name", "is \"" + read.name + "\" again; allowed: a name of its own");
    entries.push_back(std::move(read));
  });
  return entries;
}

Bisection read_bisection(JsonReader& in) {
  Bisection b;
  b.axis = in.string("axis");
  if (!b.axis.empty()) check_path(in, "axis", b.axis);
  b.lo = in.number("lo", Range::at_least(0.0));
  b.hi = in.number("hi", Range::more_than(b.lo));
  b.tol = in.number("tol", Range::more_than_up_to(0.0, std::max(b.hi - b.lo, 1e-12)));
  if (b.tol > 0.0 && (b.hi - b.lo) / b.tol > max_levels) {
    in.refuse("tol", "makes more than 10000 levels from lo to hi");
  }
  b.scan = static_cast<std::size_t>(in.integer_or("scan", 5, Range::between(2, 1000)));
  return b;
}

DesignSpec read_design(JsonReader& in) {
  DesignSpec design;
  design.kind = in.one_of<DesignKind>("kind", {{"grid", DesignKind::grid},
                                               {"list", DesignKind::list},
                                               {"random", DesignKind::random},
                                               {"bisect", DesignKind::bisect}});
  design.repeats =
      static_cast<std::uint64_t>(in.integer_or("repeats", 1, Range::between(1, max_repeats)));
  if (design.kind == DesignKind::list) design.entries = read_entries(in);
  if (design.kind == DesignKind::random) {
    design.samples =
        static_cast<std::uint64_t>(in.integer("samples", Range::between(1, max_campaign)));
  }
  if (design.kind == DesignKind::bisect) design.bisection = read_bisection(in);
  return design;
}

void read_threshold(JsonReader& in, const json& value, std::size_t index, CampaignSpec& spec) {
  const std::string place = "/thresholds/" + std::to_string(index);
  std::string text;
  bool abort = false;
  if (value.is_object()) {
    read_json(
        value, in.errors(),
        [&](JsonReader& threshold) {
          text = threshold.string("expr", 1000);
          abort = threshold.boolean_or("abort", false);
        },
        place);
    if (text.empty()) return;
  } else if (value.is_string() && value.get_ref<const std::string&>().size() <= 1000) {
    text = value.get<std::string>();
  } else {
    in.errors().add(place,
                    "is no threshold; allowed: a text as \"fall_rate == 0\", or an object "
                    "with expr and abort");
    return;
  }
  const std::string pointer = value.is_object() ? place + "/expr" : place;
  try {
    Threshold threshold = parse_threshold(text);
    threshold.abort = abort;
    if (is_limit_measure(threshold.aggregate.measure) && spec.design.kind != DesignKind::bisect) {
      in.errors().add(pointer, "asks for " + threshold.aggregate.measure +
                                   ", which designs of kind bisect alone have");
    }
    spec.thresholds.push_back(std::move(threshold));
  } catch (const ThresholdError& error) {
    in.errors().add(pointer, error.what());
  }
}

void read_thresholds(JsonReader& in, CampaignSpec& spec) {
  const json* thresholds = in.value("thresholds");
  if (thresholds == nullptr) return;
  if (!thresholds->is_array() || thresholds->size() > 1000) {
    in.refuse("thresholds", "is no array of at most 1000 thresholds");
    return;
  }
  for (std::size_t i = 0; i < thresholds->size(); ++i) {
    read_threshold(in, (*thresholds)[i], i, spec);
  }
}

void read_factors(JsonReader& in, CampaignSpec& spec) {
  const json* factors = in.value("factors");
  in.optional_object("factors", [&](JsonReader& paths) {
    for (const auto& [path, value] : factors->items()) {
      spec.factors.push_back(read_factor(paths, path, spec.design.kind == DesignKind::random));
      if (path == spec.design.bisection.axis) {
        paths.refuse(path, "is the axis of the design already");
      }
    }
  });
  if (spec.design.kind == DesignKind::random && spec.factors.empty()) {
    in.refuse("factors", "is missing; a random design draws at least one");
  }
}

}  // namespace

std::vector<std::string> path_steps(const std::string& path) {
  // Names of parameters have dots of their own.
  const std::string parameters = "parameters.";
  if (path.starts_with(parameters)) return {"parameters", path.substr(parameters.size())};
  std::vector<std::string> steps(1);
  for (const char c : path) {
    if (c == '.') {
      steps.emplace_back();
    } else {
      steps.back() += c;
    }
  }
  return steps;
}

std::string path_pointer(const std::string& path) {
  std::string pointer;
  for (const std::string& step : path_steps(path)) pointer += "/" + step;
  return pointer;
}

CampaignSpec read_campaign(const json& body, sim::JsonErrors& errors) {
  CampaignSpec spec;
  read_json(body, errors, [&spec](JsonReader& in) {
    in.integer("version", Range::between(1, 1));
    spec.name = in.string("name", 100);
    if (!spec.name.empty() && !is_name(spec.name)) {
      in.refuse("name", "is \"" + spec.name +
                            "\"; allowed: letters, digits, '-' and '_', and '.' " +
                            "after the first");
    }
    spec.seed = static_cast<std::uint64_t>(in.integer_or("seed", 1, Range::between(0, max_seed)));
    const json* base = in.value("base");
    if (base == nullptr || !base->is_object()) {
      in.refuse("base", "is no object; required: the fields that all trials share");
    } else {
      spec.base = *base;
      if (base->contains("seed")) {
        in.errors().add("/base/seed",
                        "cannot be given: every trial has its own, made from the "
                        "campaign's; a factor seed chooses them");
      }
    }
    in.object("design", [&](JsonReader& design) { spec.design = read_design(design); });
    read_factors(in, spec);
    read_thresholds(in, spec);
    in.optional_object("pass", [&](JsonReader& pass) {
      spec.recover_within_s =
          pass.optional_number("recover_within_s", Range::between(0.0, 60.0, "s"));
    });
    in.optional_object("limits", [&](JsonReader& limits) {
      spec.trial_timeout_s =
          limits.number_or("trial_timeout_s", spec.trial_timeout_s, Range::between(0.1, 3600, "s"));
      spec.max_trials = static_cast<std::uint64_t>(
          limits.integer_or("max_trials", static_cast<std::int64_t>(spec.max_trials),
                            Range::between(1, max_campaign)));
    });
  });
  return spec;
}

}  // namespace stagger::server::campaign
