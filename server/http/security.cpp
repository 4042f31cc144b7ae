#include "server/http/security.h"

#include <algorithm>
#include <cctype>

namespace stagger::server {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

struct Authority {
  std::string name;  ///< without the brackets of IPv6
  int port = 0;
};

std::optional<Authority> parse_authority(const std::string& text) {
  Authority authority;
  std::string rest;
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string::npos) return std::nullopt;
    authority.name = lower(text.substr(1, end - 1));
    rest = text.substr(end + 1);
  } else {
    const std::size_t colon = text.find(':');
    authority.name = lower(text.substr(0, colon));
    rest = colon == std::string::npos ? "" : text.substr(colon);
  }
  if (rest.empty()) {
    authority.port = 80;  // browsers leave the scheme's own port out
    return authority;
  }
  if (rest.size() < 2 || rest.size() > 6 || rest[0] != ':' ||
      !std::all_of(rest.begin() + 1, rest.end(), [](unsigned char c) { return std::isdigit(c); })) {
    return std::nullopt;
  }
  authority.port = std::stoi(rest.substr(1));
  return authority;
}

// A name server cannot make a number point elsewhere.
bool is_address(const std::string& name) {
  const bool numbers = std::all_of(name.begin(), name.end(),
                                   [](unsigned char c) { return std::isdigit(c) || c == '.'; });
  return !name.empty() && (numbers || name.find(':') != std::string::npos);
}

}  // namespace

bool is_loopback(const std::string& host) {
  return host == "localhost" || host == "::1" || (is_address(host) && host.starts_with("127."));
}

bool Gatekeeper::is_own(const std::string& host) const {
  const auto authority = parse_authority(host);
  if (!authority || authority->port != port_) return false;
  if (is_loopback(authority->name) || authority->name == lower(bound_)) return true;
  return !is_loopback(bound_) && is_address(authority->name);
}

std::optional<std::string> Gatekeeper::refusal(const std::string& host,
                                               const std::string& origin) const {
  if (!is_own(host)) return "the Host \"" + host + "\" is not this server";
  if (origin.empty()) return std::nullopt;
  const std::string same = "http://" + lower(host);
  if (lower(origin) != same) {
    return "the Origin \"" + origin + "\" is not this server's own, " + same;
  }
  return std::nullopt;
}

std::vector<std::pair<std::string, std::string>> security_headers(const std::string& host) {
  return {{"Content-Security-Policy",
           "default-src 'self'; connect-src 'self' ws://" + host +
               "; img-src 'self' data: blob:; object-src 'none'; "
               "base-uri 'none'; form-action 'self'; frame-ancestors 'none'"},
          {"X-Content-Type-Options", "nosniff"},
          {"Referrer-Policy", "no-referrer"},
          {"Cross-Origin-Resource-Policy", "same-origin"},
          {"Cross-Origin-Opener-Policy", "same-origin"}};
}

}  // namespace stagger::server
