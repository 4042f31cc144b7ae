#include "sim/json_file.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <vector>

namespace stagger::sim {
namespace {

constexpr std::size_t max_depth = 32;

TextPosition text_position_at(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto lines = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
  const std::size_t last = before.rfind('\n');
  const std::size_t start = last == std::string_view::npos ? 0 : last + 1;
  return {lines + 1, before.size() - start + 1};
}

// nlohmann's messages begin "[json.exception...] parse error at line 1, column 2: ".
std::string plain_message(const std::string& what) {
  const std::size_t colon = what.find(": ");
  return colon == std::string::npos ? what : what.substr(colon + 2);
}

/// What nlohmann's parser lets pass: a name given twice, and nesting without end.
class Strictness {
 public:
  /// Returns an empty string while all is well.
  std::string see(nlohmann::json::parse_event_t event, const nlohmann::json& parsed) {
    using Event = nlohmann::json::parse_event_t;
    switch (event) {
      case Event::object_start:
      case Event::array_start:
        names_.emplace_back();
        if (names_.size() > max_depth) {
          return "nested deeper than " + std::to_string(max_depth) + " levels";
        }
        break;
      case Event::object_end:
      case Event::array_end:
        names_.pop_back();
        break;
      case Event::key:
        if (!names_.back().insert(parsed.get<std::string>()).second) {
          return "'" + parsed.get<std::string>().substr(0, 60) + "' is given twice";
        }
        break;
      default:
        break;
    }
    return {};
  }

 private:
  std::vector<std::set<std::string>> names_;
};

/// Counts what the parser has consumed, so that an error found in a callback has a place.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, const char** furthest) : at_(at), furthest_(furthest) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    ++at_;
    *furthest_ = std::max(*furthest_, at_);
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator old = *this;
    ++*this;
    return old;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  const char** furthest_;
};

/// Walks over valid JSON text; needs no tree.
class Locator {
 public:
  explicit Locator(std::string_view text) : text_(text) {}

  std::size_t find(const std::vector<std::string>& path) {
    skip_space();
    std::size_t found = at_;
    for (const std::string& step : path) {
      if (!enter(step)) break;
      found = at_;
    }
    return found;
  }

 private:
  char now() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void skip_space() {
    while (at_ < text_.size() && std::string_view(" \t\r\n,:").find(now()) != text_.npos) ++at_;
  }

  // Moves to the member or element of the container that begins here; false when there is none.
  bool enter(const std::string& step) {
    const char open = now();
    if (open != '{' && open != '[') return false;
    ++at_;
    for (std::size_t index = 0;; ++index) {
      skip_space();
      if (at_ >= text_.size() || now() == '}' || now() == ']') return false;
      bool here = false;
      if (open == '{') {
        const std::size_t start = at_;
        skip_string();
        here = nlohmann::json::parse(text_.substr(start, at_ - start)) == step;
        skip_space();
      } else {
        here = std::to_string(index) == step;
      }
      if (here) return true;
      skip_value();
    }
  }

  void skip_string() {
    for (++at_; at_ < text_.size() && now() != '"'; ++at_) {
      if (now() == '\\') ++at_;
    }
    ++at_;
  }

  void skip_value() {
    int depth = 0;
    do {
      skip_space();
      const char c = now();
      if (c == '"') {
        skip_string();
      } else if (c == '{' || c == '[') {
        ++depth;
        ++at_;
      } else if (c == '}' || c == ']') {
        --depth;
        ++at_;
      } else {
        while (at_ < text_.size() && std::string_view(" \t\r\n,:]}").find(now()) == text_.npos)
          ++at_;
      }
    } while (depth > 0 && at_ < text_.size());
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

std::vector<std::string> split_pointer(std::string_view pointer) {
  std::vector<std::string> path;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/') {
      path.emplace_back();
    } else if (pointer[i] == '~' && i + 1 < pointer.size()) {
      ++i;
      path.back() += pointer[i] == '1' ? '/' : '~';
    } else if (!path.empty()) {
      path.back() += pointer[i];
    }
  }
  return path;
}

}  // namespace

nlohmann::json parse_json(std::string_view text) {
  const char* furthest = text.data();
  Strictness strictness;
  struct Stop {
    std::string why;
  };
  const auto watch = [&](int, nlohmann::json::parse_event_t event, nlohmann::json& parsed) {
    const std::string why = strictness.see(event, parsed);
    if (!why.empty()) throw Stop{why};
    return true;
  };
  const auto consumed = [&] { return static_cast<std::size_t>(furthest - text.data()); };
  try {
    return nlohmann::json::parse(CountingIterator(text.data(), &furthest),
                                 CountingIterator(text.data() + text.size(), &furthest), watch);
  } catch (const nlohmann::json::parse_error& error) {
    const TextPosition at = text_position_at(text, error.byte > 0 ? error.byte - 1 : 0);
    throw JsonSyntaxError(at.line, at.column, plain_message(error.what()));
  } catch (const nlohmann::json::exception& error) {  // a number beyond every double
    const TextPosition at = text_position_at(text, consumed());
    throw JsonSyntaxError(at.line, at.column, plain_message(error.what()));
  } catch (const Stop& stop) {
    const TextPosition at = text_position_at(text, consumed());
    throw JsonSyntaxError(at.line, at.column, stop.why);
  }
}

TextPosition position_of(std::string_view text, std::string_view pointer) {
  return text_position_at(text, Locator(text).find(split_pointer(pointer)));
}

std::size_t line_of(std::string_view text, std::string_view pointer) {
  return position_of(text, pointer).line;
}

void read_json_file(const std::filesystem::path& file, const JsonReader::Fields& fields) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(file.string() + ": cannot be opened");
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  nlohmann::json json;
  try {
    json = parse_json(text);
  } catch (const JsonSyntaxError& error) {
    std::ostringstream message;
    message << file.string() << ":" << error.line << ":" << error.column << ": " << error.what();
    throw std::runtime_error(message.str());
  }
  JsonErrors errors;
  read_json(json, errors, fields);
  if (errors.empty()) return;
  std::ostringstream message;
  for (const JsonError& error : errors.list()) {
    if (message.tellp() > 0) message << "\n";
    message << file.string() << ":" << line_of(text, error.pointer) << ": "
            << (error.pointer.empty() ? "" : error.pointer + " ") << error.text;
  }
  throw std::runtime_error(message.str());
}

}  // namespace stagger::sim
