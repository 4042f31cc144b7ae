#include "server/cli/list.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "sim/experiment/limits.h"

namespace stagger::server {
namespace {

constexpr std::size_t most_numbers = 1000;

[[noreturn]] void refuse_item(const std::string& option, const std::string& text,
                              const std::string& allowed) {
  throw std::invalid_argument(option + ": " + text + " is not " + allowed);
}

}  // namespace

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
  }
  return parts;
}

double read_number(const std::string& option, const std::string& text, const sim::Range& range) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !range.holds(value)) {
    refuse_item(option, '"' + text + '"', "a number, " + range.text());
  }
  return value;
}

std::vector<double> read_number_list(const std::string& option, const std::string& text,
                                     const sim::Range& range) {
  std::vector<double> numbers;
  for (const std::string& part : split(text, ',')) {
    const std::vector<std::string> ends = split(part, ':');
    if (ends.size() == 1) {
      numbers.push_back(read_number(option, part, range));
      continue;
    }
    if (ends.size() != 3) refuse_item(option, '"' + part + '"', "a number or FROM:TO:STEP");
    const double from = read_number(option, ends[0], range);
    const double to = read_number(option, ends[1], range);
    const double step = read_number(option, ends[2], sim::Range::more_than(0.0));
    if (to < from) refuse_item(option, '"' + part + '"', "FROM:TO:STEP with FROM up to TO");
    if ((to - from) / step >= static_cast<double>(most_numbers)) {
      refuse_item(option, '"' + part + '"', "a list of at most 1000 numbers");
    }
    for (const double number : sim::ladder(from, to, step)) numbers.push_back(number);
  }
  if (numbers.size() > most_numbers)
    refuse_item(option, '"' + text + '"', "a list of at most 1000 numbers");
  std::vector<double> sorted = numbers;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    refuse_item(option, '"' + text + '"', "a list of numbers that are all different");
  }
  return numbers;
}

}  // namespace stagger::server
