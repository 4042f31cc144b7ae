// A table of numbers with a line of names on top: what other programs leave behind.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stagger::sim {

/// Comma-separated values without quotes, the first line naming the columns. Every line has as many
/// values as there are columns.
class CsvTable {
 public:
  /// Throws std::runtime_error, naming file and line, when it cannot be read.
  explicit CsvTable(const std::string& file);

  std::size_t rows() const { return cells_.size(); }
  bool has(std::string_view column) const;
  /// The two throw std::runtime_error, naming file, line and column, when there is no such column
  /// or no number there.
  const std::string& text(std::size_t row, std::string_view column) const;
  double number(std::size_t row, std::string_view column) const;

 private:
  std::string file_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> cells_;
};

}  // namespace stagger::sim
