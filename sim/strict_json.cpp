#include "sim/strict_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

namespace stagger::sim {

using nlohmann::json;

namespace {

constexpr std::size_t max_errors = 100;
constexpr double max_integer = 9007199254740992.0;  // 2^53

/// The value as it was written, cut to a length that fits into a message.
std::string shown(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) {
    return value.size() > 8
               ? "an array of " + std::to_string(value.size())
               : "the array " +
                     value.dump(-1, ' ', false, json::error_handler_t::replace).substr(0, 60);
  }
  if (value.is_string()) {
    // Cut before dump(), which mends a character that was cut in two.
    const auto& text = value.get_ref<const std::string&>();
    const json part = text.substr(0, 60);
    return part.dump(-1, ' ', false, json::error_handler_t::replace) +
           (text.size() > 60 ? "..." : "");
  }
  if (value.is_number_float()) {
    const double number = value.get<double>();
    if (!std::isfinite(number)) return std::isnan(number) ? "NaN" : "infinite";
  }
  return value.dump();
}

std::string is_but(const json& value, const std::string& allowed) {
  return "is " + shown(value) + "; allowed: " + allowed;
}

std::string number_text(double value) {
  std::ostringstream out;
  out.precision(12);
  out << value;
  return out.str();
}

std::string listed(const std::vector<std::string_view>& names) {
  std::string result;
  for (const std::string_view name : names) {
    if (!result.empty()) result += ", ";
    result += name;
  }
  return result;
}

std::string kind_and_range(const std::string& kind, const Range& range) {
  const std::string text = range.text();
  return text.empty() ? kind : kind + ", " + text;
}

std::string string_rule(std::size_t max_length) {
  return "a string of 1 to " + std::to_string(max_length) + " bytes";
}

Range without_fractions(Range range) {
  range.least = std::max(range.least, -max_integer);
  range.most = std::min(range.most, max_integer);
  return range;
}

}  // namespace

void JsonErrors::add(std::string pointer, std::string text) {
  if (errors_.size() < max_errors) errors_.push_back({std::move(pointer), std::move(text)});
}

Range Range::any(std::string unit) {
  Range range;
  range.unit = std::move(unit);
  return range;
}

Range Range::between(double least, double most, std::string unit) {
  return {least, most, false, false, std::move(unit)};
}

Range Range::at_least(double least, std::string unit) {
  Range range = any(std::move(unit));
  range.least = least;
  return range;
}

Range Range::more_than(double least, std::string unit) {
  Range range = at_least(least, std::move(unit));
  range.above_least = true;
  return range;
}

Range Range::more_than_up_to(double least, double most, std::string unit) {
  return {least, most, true, false, std::move(unit)};
}

Range Range::from_to_below(double least, double most, std::string unit) {
  return {least, most, false, true, std::move(unit)};
}

bool Range::holds(double value) const {
  return std::isfinite(value) && (above_least ? value > least : value >= least) &&
         (below_most ? value < most : value <= most);
}

std::string Range::text() const {
  const bool low = std::isfinite(least);
  const bool high = std::isfinite(most);
  std::string result;
  if (low && high && least == most) {
    result = number_text(least);
  } else if (low && high) {
    result = (above_least ? "more than " : "") + number_text(least) + " to " +
             (below_most ? "less than " : "") + number_text(most);
  } else if (low) {
    result = (above_least ? "more than " : "at least ") + number_text(least);
  } else if (high) {
    result = (below_most ? "less than " : "at most ") + number_text(most);
  } else {
    return unit.empty() ? "" : "in " + unit;
  }
  return unit.empty() ? result : result + " " + unit;
}

JsonReader::JsonReader(const json& object, std::string pointer, JsonErrors& errors)
    : object_(object), pointer_(std::move(pointer)), errors_(errors) {}

bool JsonReader::has(std::string_view name) const { return object_.contains(name); }

std::string JsonReader::pointer(std::string_view name) const {
  std::string result = pointer_ + "/";
  for (const char c : name) {  // RFC 6901
    if (c == '~') {
      result += "~0";
    } else if (c == '/') {
      result += "~1";
    } else {
      result += c;
    }
  }
  return result;
}

void JsonReader::refuse(std::string_view name, std::string text) {
  errors_.add(pointer(name), std::move(text));
}

const json* JsonReader::field(std::string_view name, bool required, const std::string& allowed) {
  known_.emplace(name);
  const auto found = object_.find(name);
  if (found != object_.end()) return &*found;
  if (required) refuse(name, "is missing; required: " + allowed);
  return nullptr;
}

std::optional<double> JsonReader::read_number(std::string_view name, bool required,
                                              const Range& range) {
  const std::string allowed = kind_and_range("a number", range);
  const json* found = field(name, required, allowed);
  if (!found) return std::nullopt;
  if (!found->is_number()) {
    refuse(name, is_but(*found, allowed));
    return std::nullopt;
  }
  const auto value = found->get<double>();
  if (!range.holds(value)) {
    const std::string text = range.text();
    refuse(name, is_but(*found, std::isfinite(value) && !text.empty() ? text : allowed));
    return std::nullopt;
  }
  return value;
}

double JsonReader::number(std::string_view name, const Range& range) {
  return read_number(name, true, range).value_or(0.0);
}
double JsonReader::number_or(std::string_view name, double otherwise, const Range& range) {
  return read_number(name, false, range).value_or(otherwise);
}
std::optional<double> JsonReader::optional_number(std::string_view name, const Range& range) {
  return read_number(name, false, range);
}

std::optional<std::int64_t> JsonReader::read_integer(std::string_view name, bool required,
                                                     const Range& wanted) {
  const Range range = without_fractions(wanted);
  const std::string allowed = kind_and_range("a whole number", range);
  const json* found = field(name, required, allowed);
  if (!found) return std::nullopt;
  if (!found->is_number()) {
    refuse(name, is_but(*found, allowed));
    return std::nullopt;
  }
  const auto value = found->get<double>();
  if (!range.holds(value) || value != std::floor(value)) {
    refuse(name, is_but(*found, allowed));
    return std::nullopt;
  }
  return static_cast<std::int64_t>(value);
}

std::int64_t JsonReader::integer(std::string_view name, const Range& range) {
  return read_integer(name, true, range).value_or(0);
}
std::int64_t JsonReader::integer_or(std::string_view name, std::int64_t otherwise,
                                    const Range& range) {
  return read_integer(name, false, range).value_or(otherwise);
}
std::optional<std::int64_t> JsonReader::optional_integer(std::string_view name,
                                                         const Range& range) {
  return read_integer(name, false, range);
}

std::optional<bool> JsonReader::read_boolean(std::string_view name, bool required) {
  const std::string allowed = "true, false";
  const json* found = field(name, required, allowed);
  if (!found) return std::nullopt;
  if (!found->is_boolean()) {
    refuse(name, is_but(*found, allowed));
    return std::nullopt;
  }
  return found->get<bool>();
}

bool JsonReader::boolean(std::string_view name) { return read_boolean(name, true).value_or(false); }
bool JsonReader::boolean_or(std::string_view name, bool otherwise) {
  return read_boolean(name, false).value_or(otherwise);
}
std::optional<bool> JsonReader::optional_boolean(std::string_view name) {
  return read_boolean(name, false);
}

std::optional<std::string> JsonReader::read_string(std::string_view name, bool required,
                                                   std::size_t max_length) {
  const std::string allowed = string_rule(max_length);
  const json* found = field(name, required, allowed);
  if (!found) return std::nullopt;
  if (!found->is_string() || found->get_ref<const std::string&>().empty() ||
      found->get_ref<const std::string&>().size() > max_length) {
    refuse(name, is_but(*found, allowed));
    return std::nullopt;
  }
  return found->get<std::string>();
}

std::string JsonReader::string(std::string_view name, std::size_t max_length) {
  return read_string(name, true, max_length).value_or("");
}
std::string JsonReader::string_or(std::string_view name, std::string otherwise,
                                  std::size_t max_length) {
  return read_string(name, false, max_length).value_or(std::move(otherwise));
}
std::optional<std::string> JsonReader::optional_string(std::string_view name,
                                                       std::size_t max_length) {
  return read_string(name, false, max_length);
}

std::optional<engine::Vec3> JsonReader::read_vec3(std::string_view name, bool required,
                                                  const Range& range) {
  const std::string allowed = kind_and_range("an array of three numbers", range);
  const json* found = field(name, required, allowed);
  if (!found) return std::nullopt;
  if (!found->is_array() || found->size() != 3) {
    refuse(name, is_but(*found, allowed));
    return std::nullopt;
  }
  engine::Vec3 result;
  for (int i = 0; i < 3; ++i) {
    const json& element = (*found)[static_cast<std::size_t>(i)];
    if (!element.is_number() || !range.holds(element.get<double>())) {
      errors_.add(pointer(name) + "/" + std::to_string(i),
                  is_but(element, kind_and_range("a number", range)));
      return std::nullopt;
    }
    result[i] = element.get<double>();
  }
  return result;
}

engine::Vec3 JsonReader::vec3(std::string_view name, const Range& range) {
  return read_vec3(name, true, range).value_or(engine::Vec3::Zero());
}
engine::Vec3 JsonReader::vec3_or(std::string_view name, const engine::Vec3& otherwise,
                                 const Range& range) {
  return read_vec3(name, false, range).value_or(otherwise);
}
std::optional<engine::Vec3> JsonReader::optional_vec3(std::string_view name, const Range& range) {
  return read_vec3(name, false, range);
}

std::optional<std::size_t> JsonReader::choose(std::string_view name,
                                              const std::vector<std::string_view>& names,
                                              bool required) {
  const json* found = field(name, required, listed(names));
  if (!found) return std::nullopt;
  if (found->is_string()) {
    const auto& text = found->get_ref<const std::string&>();
    const auto at = std::find(names.begin(), names.end(), text);
    if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  }
  refuse(name, is_but(*found, listed(names)));
  return std::nullopt;
}

void JsonReader::object(std::string_view name, const Fields& fields) {
  const json* found = field(name, true, "an object");
  if (found) read_json(*found, errors_, fields, pointer(name));
}

bool JsonReader::optional_object(std::string_view name, const Fields& fields) {
  const json* found = field(name, false, "an object");
  if (!found) return false;
  read_json(*found, errors_, fields, pointer(name));
  return found->is_object();
}

std::map<std::string, double> JsonReader::numbers(std::string_view name, const Range& range) {
  std::map<std::string, double> result;
  object(name, [&](JsonReader& in) {
    for (const auto& [key, unused] : in.object_.items()) result[key] = in.number(key, range);
  });
  return result;
}

const json* JsonReader::read_array(std::string_view name, const Range& count,
                                   const std::string& of_what) {
  const std::string length = without_fractions(count).text();
  const std::string allowed = "an array of " + of_what + ", length " + length;
  const json* found = field(name, true, allowed);
  if (!found) return nullptr;
  if (!found->is_array() || !count.holds(static_cast<double>(found->size()))) {
    refuse(name, is_but(*found, allowed));
    return nullptr;
  }
  return found;
}

std::vector<double> JsonReader::number_list(std::string_view name, const Range& range,
                                            const Range& count) {
  std::vector<double> result;
  const json* found = read_array(name, count, "numbers");
  if (!found) return result;
  for (std::size_t i = 0; i < found->size(); ++i) {
    const json& element = (*found)[i];
    if (element.is_number() && range.holds(element.get<double>())) {
      result.push_back(element.get<double>());
    } else {
      errors_.add(pointer(name) + "/" + std::to_string(i),
                  is_but(element, kind_and_range("a number", range)));
    }
  }
  return result;
}

std::vector<std::string> JsonReader::string_list(std::string_view name, const Range& count,
                                                 std::size_t max_length) {
  std::vector<std::string> result;
  const json* found = read_array(name, count, "strings");
  if (!found) return result;
  for (std::size_t i = 0; i < found->size(); ++i) {
    const json& element = (*found)[i];
    if (element.is_string() && !element.get_ref<const std::string&>().empty() &&
        element.get_ref<const std::string&>().size() <= max_length) {
      result.push_back(element.get<std::string>());
    } else {
      errors_.add(pointer(name) + "/" + std::to_string(i),
                  is_but(element, string_rule(max_length)));
    }
  }
  return result;
}

void JsonReader::object_list(std::string_view name, const Range& count, const Fields& fields) {
  const json* found = read_array(name, count, "objects");
  if (!found) return;
  for (std::size_t i = 0; i < found->size(); ++i) {
    read_json((*found)[i], errors_, fields, pointer(name) + "/" + std::to_string(i));
  }
}

const json* JsonReader::value(std::string_view name) { return field(name, false, ""); }

void JsonReader::refuse_unknown() {
  std::vector<std::string_view> names(known_.begin(), known_.end());
  for (const auto& [key, unused] : object_.items()) {
    if (known_.contains(key)) continue;
    refuse(std::string_view(key).substr(0, 100), "is no field here; allowed: " + listed(names));
  }
}

void read_json(const json& value, JsonErrors& errors, const JsonReader::Fields& fields,
               std::string pointer) {
  if (!value.is_object()) {
    errors.add(std::move(pointer), is_but(value, "an object"));
    return;
  }
  JsonReader reader(value, std::move(pointer), errors);
  fields(reader);
  reader.refuse_unknown();
}

}  // namespace stagger::sim
