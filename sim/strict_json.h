// Reads JSON into typed values and tells everything that is wrong with it at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/types.h"

namespace stagger::sim {

/// One thing that is wrong: where (JSON pointer, "" for the whole document) and what.
struct JsonError {
  std::string pointer;
  std::string text;  ///< e.g. "is -3; allowed: more than 0 to 200 N s"
};

/// Errors in the order in which they were found. Keeps the first 100: a hostile document must not
/// make a huge answer.
class JsonErrors {
 public:
  void add(std::string pointer, std::string text);
  bool empty() const { return errors_.empty(); }
  const std::vector<JsonError>& list() const { return errors_; }

 private:
  std::vector<JsonError> errors_;
};

/// Allowed numbers, with their unit for the message. Never lets NaN or infinity pass.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above_least = false;  ///< least itself is not allowed
  bool below_most = false;   ///< most itself is not allowed
  std::string unit;

  static Range any(std::string unit = "");
  static Range between(double least, double most, std::string unit = "");
  static Range at_least(double least, std::string unit = "");
  static Range more_than(double least, std::string unit = "");
  /// least < value <= most
  static Range more_than_up_to(double least, double most, std::string unit = "");
  /// least <= value < most
  static Range from_to_below(double least, double most, std::string unit = "");

  bool holds(double value) const;
  std::string text() const;  ///< "more than 0 to 200 N s"
};

/// Names and values of an enumeration.
template <typename T>
using Names = std::vector<std::pair<std::string_view, T>>;

/// Reads the fields of one JSON object. Every field that is asked for is a known field; the others
/// are refused. A field that is missing or wrong becomes an error and reads as its default (or as a
/// harmless value of its type): after reading, look at the errors before using anything.
///
///   JsonErrors errors;
///   PushSpec push;
///   read_json(body, errors, [&](JsonReader& in) {
///     push.impulse_ns = in.number("impulse_ns", Range::more_than_up_to(0, 200, "N s"));
///     push.duration_s = in.number_or("duration_s", 0.1, Range::between(0.001, 5, "s"));
///   });
class JsonReader {
 public:
  using Fields = std::function<void(JsonReader&)>;

  /// Was the field given? Does not make it a known field.
  bool has(std::string_view name) const;
  /// JSON pointer of a field of this object.
  std::string pointer(std::string_view name) const;
  /// Adds an error of the caller's own about a field.
  void refuse(std::string_view name, std::string text);
  /// Where the errors go; for checks that concern more than one object.
  JsonErrors& errors() { return errors_; }

  double number(std::string_view name, const Range& range = {});
  double number_or(std::string_view name, double otherwise, const Range& range = {});
  std::optional<double> optional_number(std::string_view name, const Range& range = {});

  /// Whole numbers (3.0 is one), at most 2^53 either way: more does not survive JavaScript.
  std::int64_t integer(std::string_view name, const Range& range = {});
  std::int64_t integer_or(std::string_view name, std::int64_t otherwise, const Range& range = {});
  std::optional<std::int64_t> optional_integer(std::string_view name, const Range& range = {});

  bool boolean(std::string_view name);
  bool boolean_or(std::string_view name, bool otherwise);
  std::optional<bool> optional_boolean(std::string_view name);

  /// Strings must not be empty, nor longer than max_length bytes.
  std::string string(std::string_view name, std::size_t max_length = 256);
  std::string string_or(std::string_view name, std::string otherwise, std::size_t max_length = 256);
  std::optional<std::string> optional_string(std::string_view name, std::size_t max_length = 256);

  /// [x, y, z], each within the range.
  engine::Vec3 vec3(std::string_view name, const Range& range = {});
  engine::Vec3 vec3_or(std::string_view name, const engine::Vec3& otherwise,
                       const Range& range = {});
  std::optional<engine::Vec3> optional_vec3(std::string_view name, const Range& range = {});

  /// One of the names; its value.
  template <typename T>
  T one_of(std::string_view name, const Names<T>& names) {
    return names[choose(name, texts(names), true).value_or(0)].second;
  }
  template <typename T>
  T one_of_or(std::string_view name, T otherwise, const Names<T>& names) {
    const auto chosen = choose(name, texts(names), false);
    return chosen ? names[*chosen].second : otherwise;
  }
  template <typename T>
  std::optional<T> optional_one_of(std::string_view name, const Names<T>& names) {
    const auto chosen = choose(name, texts(names), false);
    return chosen ? std::optional<T>(names[*chosen].second) : std::nullopt;
  }

  /// A nested object; `fields` is called with its reader unless it is missing or no object.
  void object(std::string_view name, const Fields& fields);
  /// The same for one that may be missing; tells whether it was read.
  bool optional_object(std::string_view name, const Fields& fields);

  /// An object with free names and numbers as values.
  std::map<std::string, double> numbers(std::string_view name, const Range& range = {});
  /// An array of numbers or of strings. `count` limits its length.
  std::vector<double> number_list(std::string_view name, const Range& range, const Range& count);
  std::vector<std::string> string_list(std::string_view name, const Range& count,
                                       std::size_t max_length = 256);
  /// An array of objects; `fields` is called for each.
  void object_list(std::string_view name, const Range& count, const Fields& fields);

  /// The field as it is; null when it is missing. For what no function above can read.
  const nlohmann::json* value(std::string_view name);

 private:
  friend void read_json(const nlohmann::json&, JsonErrors&, const Fields&, std::string);

  JsonReader(const nlohmann::json& object, std::string pointer, JsonErrors& errors);

  template <typename T>
  static std::vector<std::string_view> texts(const Names<T>& names) {
    std::vector<std::string_view> result;
    for (const auto& [text, value] : names) result.push_back(text);
    return result;
  }

  // Remembers that the field is known; null when it is missing (an error when it is required).
  const nlohmann::json* field(std::string_view name, bool required, const std::string& allowed);
  std::optional<double> read_number(std::string_view name, bool required, const Range& range);
  std::optional<std::int64_t> read_integer(std::string_view name, bool required,
                                           const Range& range);
  std::optional<bool> read_boolean(std::string_view name, bool required);
  std::optional<std::string> read_string(std::string_view name, bool required,
                                         std::size_t max_length);
  std::optional<engine::Vec3> read_vec3(std::string_view name, bool required, const Range& range);
  std::optional<std::size_t> choose(std::string_view name,
                                    const std::vector<std::string_view>& names, bool required);
  const nlohmann::json* read_array(std::string_view name, const Range& count,
                                   const std::string& of_what);
  void refuse_unknown();

  const nlohmann::json& object_;
  std::string pointer_;
  JsonErrors& errors_;
  std::set<std::string, std::less<>> known_;
};

/// Reads a value that must be an object: calls `fields`, then refuses the fields that it did not
/// ask for. `pointer` is where the value stands in its document.
void read_json(const nlohmann::json& value, JsonErrors& errors, const JsonReader::Fields& fields,
               std::string pointer = "");

}  // namespace stagger::sim
