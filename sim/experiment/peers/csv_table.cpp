#include "sim/experiment/peers/csv_table.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace stagger::sim {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

CsvTable::CsvTable(const std::string& file) : file_(file) {
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line)) throw std::runtime_error("cannot read " + file);
  columns_ = split(line);
  while (std::getline(in, line)) {
    cells_.push_back(split(line));
    if (cells_.back().size() != columns_.size()) {
      throw std::runtime_error(file + ':' + std::to_string(rows() + 1) + ": " +
                               std::to_string(cells_.back().size()) + " values for " +
                               std::to_string(columns_.size()) + " columns");
    }
  }
}

bool CsvTable::has(std::string_view column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

const std::string& CsvTable::text(std::size_t row, std::string_view column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found == columns_.end())
    throw std::runtime_error(file_ + ": no column " + std::string(column));
  return cells_[row][static_cast<std::size_t>(found - columns_.begin())];
}

double CsvTable::number(std::size_t row, std::string_view column) const {
  const std::string& cell = text(row, column);
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) {
    // The names are in the first line.
    throw std::runtime_error(file_ + ':' + std::to_string(row + 2) + ": " + std::string(column) +
                             " is no number: " + cell);
  }
  return value;
}

}  // namespace stagger::sim
