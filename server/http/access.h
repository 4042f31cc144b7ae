// Who may do what: keys, and tickets for those who cannot send a header.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "server/http/message.h"
#include "server/http/problem.h"

namespace stagger::server {

/// Does `given` equal `secret`? Takes as long for a near miss as for any other text of its length.
bool equal_in_constant_time(const std::string& given, const std::string& secret);

/// Why a text cannot be a key, or nothing when it can.
std::optional<std::string> why_no_key(const std::string& text);

struct ApiKeys {
  std::string full;       ///< may do everything; empty: there is none
  std::string read_only;  ///< may look, not command; empty: there is none
};

/// With no key at all everything is open to whoever reaches the server.
class Access {
 public:
  using Clock = std::chrono::steady_clock;

  static constexpr std::chrono::seconds ticket_life{30};
  /// Tickets that wait to be used; one more, and the oldest is void.
  static constexpr std::size_t max_tickets = 1024;

  explicit Access(ApiKeys keys) : keys_(std::move(keys)) {}

  bool asks_for_a_key() const { return !keys_.full.empty() || !keys_.read_only.empty(); }

  /// Nothing when the request may pass: 401 without a key or with a wrong one, 403 when the key may
  /// only look. The dashboard's files, /health and /ready are open to all.
  std::optional<Problem> refusal(const HttpRequest& request) const;

  /// A random ticket that opens one stream, once, within `ticket_life`.
  std::string issue_ticket(Clock::time_point now);
  /// True once for each ticket that was issued and is still alive.
  bool redeem(const std::string& ticket, Clock::time_point now);

 private:
  const ApiKeys keys_;
  std::mutex mutex_;
  std::deque<std::pair<Clock::time_point, std::string>> tickets_;  // oldest first
};

}  // namespace stagger::server
