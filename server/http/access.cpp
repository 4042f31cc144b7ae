#include "server/http/access.h"

#include <algorithm>
#include <random>

#include "sim/state_hash.h"

namespace stagger::server {
namespace {

constexpr std::size_t least_key_length = 16;
constexpr std::size_t most_key_length = 512;
constexpr const char* tickets_path = "/api/v1/tickets";

std::string key_of(const HttpRequest& request) {
  const std::string authorization = request.header("authorization");
  // The scheme's name is not case-sensitive.
  const std::string scheme = "bearer ";
  const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  if (authorization.size() > scheme.size() &&
      std::equal(scheme.begin(), scheme.end(), authorization.begin(),
                 [&](char s, char a) { return same(a, s); })) {
    return authorization.substr(scheme.size());
  }
  return request.header("x-api-key");
}

bool is_public(const HttpRequest& request) {
  // Numbers about the machine are nobody else's business; the page and the two probes hold none.
  return !request.path.starts_with("/api/") && request.path != "/metrics";
}

bool only_looks(const HttpRequest& request) {
  return request.method == "GET" || request.method == "HEAD" || request.path == tickets_path;
}

// 64 bits from the system's own source.
std::uint64_t random_bits() {
  static thread_local std::random_device device;
  return (std::uint64_t{device()} << 32) ^ device();
}

}  // namespace

bool equal_in_constant_time(const std::string& given, const std::string& secret) {
  if (secret.empty()) return false;
  // No early end, and no branch on what is compared. The length of the secret may show, as it does
  // in its documentation.
  volatile unsigned difference = given.size() == secret.size() ? 0U : 1U;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const auto a = static_cast<unsigned char>(given[i]);
    const auto b = static_cast<unsigned char>(secret[i % secret.size()]);
    difference = difference | static_cast<unsigned>(a ^ b);
  }
  return difference == 0;
}

std::optional<std::string> why_no_key(const std::string& text) {
  if (text.size() < least_key_length || text.size() > most_key_length) {
    return "has " + std::to_string(text.size()) +
           " characters; allowed: " + std::to_string(least_key_length) + " to " +
           std::to_string(most_key_length);
  }
  const bool plain =
      std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
  if (!plain) return "holds a blank or a character beyond ASCII; allowed: visible ASCII";
  return std::nullopt;
}

std::optional<Problem> Access::refusal(const HttpRequest& request) const {
  if (!asks_for_a_key() || is_public(request)) return std::nullopt;
  const std::string key = key_of(request);
  // Both are compared whatever the first says.
  const bool full = equal_in_constant_time(key, keys_.full);
  const bool read_only = equal_in_constant_time(key, keys_.read_only);
  if (full || (read_only && only_looks(request))) return std::nullopt;
  if (read_only) return Problem(403, "this key may look, not command");
  return Problem(401, key.empty() ? "a key is needed: Authorization: Bearer KEY, or X-Api-Key: KEY"
                                  : "the key is not valid")
      .with_header("WWW-Authenticate", "Bearer");
}

std::string Access::issue_ticket(Clock::time_point now) {
  std::string ticket = sim::to_hex(random_bits()) + sim::to_hex(random_bits());
  const std::lock_guard lock(mutex_);
  if (tickets_.size() >= max_tickets) tickets_.pop_front();
  tickets_.emplace_back(now + ticket_life, ticket);
  return ticket;
}

bool Access::redeem(const std::string& ticket, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  while (!tickets_.empty() && tickets_.front().first < now) tickets_.pop_front();
  auto found = tickets_.end();
  for (auto candidate = tickets_.begin(); candidate != tickets_.end(); ++candidate) {
    if (equal_in_constant_time(ticket, candidate->second)) found = candidate;
  }
  if (found == tickets_.end()) return false;
  tickets_.erase(found);
  return true;
}

}  // namespace stagger::server
