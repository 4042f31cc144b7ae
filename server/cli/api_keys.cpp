#include "server/cli/api_keys.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace stagger::server {
namespace {

namespace fs = std::filesystem;

constexpr auto others_may_read = fs::perms::group_read | fs::perms::others_read;

std::optional<std::string> refuse_key(const std::string& source, const std::string& why) {
  std::cerr << "stagger: " << source << ' ' << why << '\n';
  return std::nullopt;
}

/// The first line.
std::optional<std::string> read_key_file(const std::string& option, const std::string& file) {
  const std::string source = option + " " + file;
  std::ifstream in(file);
  std::string key;
  if (!in || !fs::is_regular_file(file)) return refuse_key(source, "cannot be read");
  std::getline(in, key);
  if (!key.empty() && key.back() == '\r') key.pop_back();
  if (const auto why = why_no_key(key)) return refuse_key(source, *why);
  std::error_code error;
  const fs::perms permissions = fs::status(file, error).permissions();
  if (!error && (permissions & others_may_read) != fs::perms::none) {
    std::cerr << "stagger: " << source << " can be read by other users; chmod 600 it\n";
  }
  return key;
}

std::optional<std::string> read_key(const std::string& option, const std::string& file,
                                    const char* variable) {
  if (!file.empty()) return read_key_file(option, file);
  const char* value = std::getenv(variable);
  if (value == nullptr || *value == '\0') return "";
  if (const auto why = why_no_key(value)) return refuse_key(variable, *why);
  return value;
}

}  // namespace

std::optional<ApiKeys> read_api_keys(const std::string& full_file,
                                     const std::string& read_only_file) {
  const auto full = read_key("--api-key-file", full_file, "STAGGER_API_KEY");
  const auto read_only = read_key("--read-only-key-file", read_only_file, "STAGGER_READ_ONLY_KEY");
  if (!full || !read_only) return std::nullopt;
  if (full->empty() && !read_only->empty()) {
    refuse_key("the read-only key", "stands alone: nobody could command; give an API key too");
    return std::nullopt;
  }
  if (!full->empty() && *full == *read_only) {
    refuse_key("the read-only key", "is the API key; allowed: another one");
    return std::nullopt;
  }
  return ApiKeys{*full, *read_only};
}

}  // namespace stagger::server
