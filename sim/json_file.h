// JSON as text: strict parsing, and the way back from a JSON pointer to a line of a file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

#include "sim/strict_json.h"

namespace stagger::sim {

/// Text that is no JSON. Lines and columns count from 1.
class JsonSyntaxError : public std::runtime_error {
 public:
  JsonSyntaxError(std::size_t at_line, std::size_t at_column, const std::string& what)
      : std::runtime_error(what), line(at_line), column(at_column) {}
  std::size_t line;
  std::size_t column;
};

/// Parses one JSON value. Beyond the grammar, refuses a name given twice in one object and nesting
/// deeper than 32. Throws JsonSyntaxError.
nlohmann::json parse_json(std::string_view text);

/// A place in a text; lines and columns count from 1.
struct TextPosition {
  std::size_t line = 1;
  std::size_t column = 1;
};

/// Place in valid JSON text at which the value at `pointer` begins, or, when there is no such
/// value, the innermost value around it.
TextPosition position_of(std::string_view text, std::string_view pointer);

/// Line of valid JSON text on which the value at `pointer` begins, or, when there is no such value,
/// the innermost value around it.
std::size_t line_of(std::string_view text, std::string_view pointer);

/// Reads a file that holds one JSON object. Throws std::runtime_error with one line of message for
/// every error: "file:line: /pointer text".
void read_json_file(const std::filesystem::path& file, const JsonReader::Fields& fields);

}  // namespace stagger::sim
