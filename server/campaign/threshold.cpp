#include "server/campaign/threshold.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numeric>

namespace stagger::server::campaign {
namespace {

using Names = std::vector<std::string>;

const Names& functions() {
  static const Names names{"min", "max", "mean", "median", "p95"};
  return names;
}

bool contains(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string listed(const Names& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

constexpr std::array<std::pair<std::string_view, Comparison>, 6> comparisons{
    {{"==", Comparison::equal},
     {"!=", Comparison::unequal},
     {"<=", Comparison::at_most},
     {">=", Comparison::at_least},
     {"<", Comparison::less},
     {">", Comparison::greater}}};

/// Reads "aggregate op number [where path op value [and ...]]".
class Parser {
 public:
  explicit Parser(const std::string& text) : text_(text) {}

  Threshold parse() {
    Threshold threshold;
    threshold.text = text_;
    threshold.aggregate = aggregate();
    threshold.comparison = comparison();
    threshold.value = number();
    if (!at_end()) {
      if (word() != "where") refuse("'where' or the end");
      do {
        threshold.conditions.push_back(condition());
      } while (!at_end() && conjunction());
    }
    return threshold;
  }

 private:
  static bool in_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
  }

  [[noreturn]] void refuse(const std::string& wanted) const {
    throw ThresholdError("is \"" + text_ + "\"; at character " + std::to_string(start_ + 1) +
                         " allowed: " + wanted);
  }

  bool at_end() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    start_ = at_;
    return at_ == text_.size();
  }

  bool take(char c) {
    if (at_end() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  std::string word() {
    at_end();
    while (at_ < text_.size() && in_word(text_[at_])) ++at_;
    return text_.substr(start_, at_ - start_);
  }

  Aggregate aggregate() {
    const std::string name = word();
    if (!take('(')) {
      if (contains(plain_measures(), name)) return {"", name};
      start_ = 0;
      refuse(listed(plain_measures()) + "; or " + listed(functions()) + " of (" +
             listed(trial_measures()) + ", " + listed(limit_measures()) + ")");
    }
    if (!contains(functions(), name)) {
      start_ = 0;
      refuse(listed(functions()));
    }
    std::string measure = word();
    if (!contains(trial_measures(), measure) && !contains(limit_measures(), measure)) {
      refuse(listed(trial_measures()) + ", " + listed(limit_measures()));
    }
    if (!take(')')) refuse("')'");
    return {name, std::move(measure)};
  }

  Comparison comparison() {
    at_end();
    for (const auto& [sign, meaning] : comparisons) {
      if (text_.compare(at_, sign.size(), sign) != 0) continue;
      at_ += sign.size();
      return meaning;
    }
    refuse("==, !=, <, <=, >, >=");
  }

  double number() {
    at_end();
    double value = 0.0;
    const char* const end = text_.data() + text_.size();
    const auto [rest, error] = std::from_chars(text_.data() + at_, end, value);
    const bool whole = rest == end || !in_word(*rest);
    if (error != std::errc() || !std::isfinite(value) || !whole) refuse("a number");
    at_ = static_cast<std::size_t>(rest - text_.data());
    return value;
  }

  nlohmann::json value() {
    if (take('"')) {
      const std::size_t close = text_.find('"', at_);
      if (close == std::string::npos) refuse("a text that ends with a quotation mark");
      std::string text = text_.substr(at_, close - at_);
      at_ = close + 1;
      return text;
    }
    const std::size_t before = at_;
    const std::string name = word();
    if (name == "true") return true;
    if (name == "false") return false;
    if (!name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) != 0) return name;
    at_ = before;
    return number();
  }

  Condition condition() {
    Condition result;
    result.path = word();
    if (result.path.empty()) refuse("a field of the trial");
    result.comparison = comparison();
    const std::size_t before = start_;
    result.value = value();
    const bool ordered =
        result.comparison != Comparison::equal && result.comparison != Comparison::unequal;
    if (ordered && !result.value.is_number()) {
      start_ = before;
      refuse("== or != before what is no number");
    }
    return result;
  }

  bool conjunction() {
    if (word() != "and") refuse("'and' or the end");
    return true;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  std::size_t start_ = 0;  ///< of what was read last
};

}  // namespace

const std::vector<std::string>& plain_measures() {
  static const Names names{"fall_rate", "pass_rate", "trials", "falls", "timeouts", "invalid"};
  return names;
}

const std::vector<std::string>& trial_measures() {
  static const Names names{"delta_v",         "fr",          "delivered_ns",     "steps_to_recover",
                           "recovery_time_s", "fall_time_s", "worst_dcm_error_m"};
  return names;
}

const std::vector<std::string>& limit_measures() {
  static const Names names{"limit", "limit_ns", "limit_dv", "limit_fr", "limit_percent"};
  return names;
}

bool is_limit_measure(std::string_view name) { return contains(limit_measures(), name); }

bool holds(Comparison comparison, double left, double right) {
  switch (comparison) {
    case Comparison::equal:
      return left == right;
    case Comparison::unequal:
      return left != right;
    case Comparison::less:
      return left < right;
    case Comparison::at_most:
      return left <= right;
    case Comparison::greater:
      return left > right;
    case Comparison::at_least:
      return left >= right;
  }
  return false;
}

Threshold parse_threshold(const std::string& text) { return Parser(text).parse(); }

bool holds(const Condition& condition, const nlohmann::json& value) {
  if (value.is_null()) return false;
  if (value.is_number() && condition.value.is_number()) {
    return holds(condition.comparison, value.get<double>(), condition.value.get<double>());
  }
  const bool same = value == condition.value;
  return condition.comparison == Comparison::unequal
             ? !same
             : same && condition.comparison == Comparison::equal;
}

std::optional<double> statistic(const std::string& function, std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  const auto count = static_cast<double>(values.size());
  if (function == "mean") return std::accumulate(values.begin(), values.end(), 0.0) / count;
  std::sort(values.begin(), values.end());
  if (function == "min") return values.front();
  if (function == "max") return values.back();
  // Nearest rank: a value that was really measured.
  const double share = function == "median" ? 0.5 : 0.95;
  return values[static_cast<std::size_t>(std::max(std::ceil(share * count), 1.0)) - 1];
}

}  // namespace stagger::server::campaign
