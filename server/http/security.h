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
/// and the Origin, when there is one, must be that same host.
class Gatekeeper {
 public:
  /// `bound` is the address that the server listens on.
  Gatekeeper(std::string bound, int port) : bound_(std::move(bound)), port_(port) {}

  /// Nothing when the request may pass; else why not. "" stands for a header that is missing.
  std::optional<std::string> refusal(const std::string& host, const std::string& origin) const;

 private:
  bool is_own(const std::string& host) const;

  std::string bound_;
  int port_;
};

/// Sent with every answer. `host` is the Host header that has been let in: the dashboard may open
/// its WebSocket there.
std::vector<std::pair<std::string, std::string>> security_headers(const std::string& host);

}  // namespace stagger::server
