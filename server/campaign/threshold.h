// What has to come out of a campaign: "fall_rate == 0 where push.impulse_ns <= 8".
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace stagger::server::campaign {

enum class Comparison : std::uint8_t { equal, unequal, less, at_most, greater, at_least };

bool holds(Comparison comparison, double left, double right);

/// "push.impulse_ns <= 8": of one trial, or of one limit of a bisection.
struct Condition {
  std::string path;
  Comparison comparison = Comparison::equal;
  nlohmann::json value;  ///< number, text or boolean; texts and booleans are (un)equal only
};

/// What is made of the trials: a rate or a count of all, or a statistic of a measure.
struct Aggregate {
  std::string function;  ///< "min", "max", "mean", "median", "p95"; empty: `measure` itself
  std::string measure;   ///< "fall_rate"; "steps_to_recover", "limit_ns"
};

struct Threshold {
  std::string text;
  Aggregate aggregate;
  Comparison comparison = Comparison::equal;
  double value = 0.0;
  std::vector<Condition> conditions;  ///< all have to hold
  bool abort = false;                 ///< end the campaign as soon as it fails
};

/// Rates and counts that stand alone.
const std::vector<std::string>& plain_measures();
/// Measures of one trial.
const std::vector<std::string>& trial_measures();
/// Measures of one limit of a bisection.
const std::vector<std::string>& limit_measures();
bool is_limit_measure(std::string_view name);

/// A text that is no threshold. The message says where and what is allowed.
class ThresholdError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws ThresholdError.
Threshold parse_threshold(const std::string& text);

/// Does it hold for this value of the field? A field that is missing (null) fails.
bool holds(const Condition& condition, const nlohmann::json& value);

/// The statistic of that name; nothing of no values.
std::optional<double> statistic(const std::string& function, std::vector<double> values);

}  // namespace stagger::server::campaign
