// Who may talk to the server, and what a browser may do with its answers.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace stagger::server {

/// Is this the address of this machine itself ("127.0.0.1", "::1", "localhost")?
bool is_loopback(const std::string& host);

/// A web page elsewhere can make its visitor's browser send requests here. Two checks stop it: the
/// Host must be one of our own names (a foreign name that was made to point at 127.0.0.1 is not),
/// and the Origin, when there is one, must be that same host, or one that was allowed by name.
class Gatekeeper {
 public:
  struct Allowed {
    std::vector<std::string> hosts;    ///< "name" on any port, or "name:port"
    std::vector<std::string> origins;  ///< "scheme://name" or "scheme://name:port"
  };

  /// `bound` is the address that the server listens on.
  Gatekeeper(std::string bound, int port, Allowed allowed = {})
      : bound_(std::move(bound)), port_(port), allowed_(std::move(allowed)) {}

  /// Nothing when the request may pass; else why not. "" stands for a header that is missing.
  std::optional<std::string> refusal(const std::string& host, const std::string& origin) const;
  /// Is it the origin of a page elsewhere that may use the API?
  bool is_allowed_origin(const std::string& origin) const;

 private:
  bool is_own(const std::string& host) const;
  bool is_allowed_host(const std::string& host) const;

  std::string bound_;
  int port_;
  Allowed allowed_;
};

/// Why a text cannot be on the list of allowed hosts or origins, or nothing when it can.
std::optional<std::string> why_no_host(const std::string& text);
std::optional<std::string> why_no_origin(const std::string& text);

using Headers = std::vector<std::pair<std::string, std::string>>;

/// Sent with every answer. `host` is the Host header that has been let in: the dashboard may open
/// its WebSocket there.
Headers security_headers(const std::string& host);

/// Tells a browser that a page of `origin` may read the answer.
Headers cross_origin_headers(const std::string& origin);
/// The answer to a browser that asks, before a request, whether a page elsewhere may send it.
Headers preflight_headers();

}  // namespace stagger::server
