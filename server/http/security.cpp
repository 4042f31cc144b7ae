#include "server/http/security.h"

#include <algorithm>

#include "server/http/message.h"

namespace stagger::server {
namespace {

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

// Is there a port behind the name?
bool names_port(const std::string& text) {
  return text.find(':', text.starts_with('[') ? text.find(']') : 0) != std::string::npos;
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

bool Gatekeeper::is_allowed_host(const std::string& host) const {
  const auto authority = parse_authority(host);
  if (!authority) return false;
  return std::any_of(allowed_.hosts.begin(), allowed_.hosts.end(), [&](const std::string& text) {
    const auto allowed = parse_authority(text);
    if (!allowed || allowed->name != authority->name) return false;
    return !names_port(text) || allowed->port == authority->port;
  });
}

bool Gatekeeper::is_allowed_origin(const std::string& origin) const {
  return std::any_of(allowed_.origins.begin(), allowed_.origins.end(),
                     [&](const std::string& text) { return lower(text) == lower(origin); });
}

std::optional<std::string> Gatekeeper::refusal(const std::string& host,
                                               const std::string& origin) const {
  const bool by_list = is_allowed_host(host);
  if (!by_list && !is_own(host)) return "the Host \"" + host + "\" is not this server";
  if (origin.empty() || is_allowed_origin(origin)) return std::nullopt;
  const std::string same = "http://" + lower(host);
  if (lower(origin) == same) return std::nullopt;
  // A proxy in front of a name on the list may speak TLS.
  if (by_list && lower(origin) == "https://" + lower(host)) return std::nullopt;
  return "the Origin \"" + origin + "\" is not this server's own, " + same;
}

std::optional<std::string> why_no_host(const std::string& text) {
  const auto authority = parse_authority(text);
  const bool plain = std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '-' || c == '_' || c == ':' || c == '[' ||
           c == ']';
  });
  if (authority && plain && !authority->name.empty()) return std::nullopt;
  return "allowed: NAME or NAME:PORT, as robot.example";
}

std::optional<std::string> why_no_origin(const std::string& text) {
  for (const std::string& scheme : {std::string("http://"), std::string("https://")}) {
    if (lower(text).starts_with(scheme) && !why_no_host(text.substr(scheme.size()))) {
      return std::nullopt;
    }
  }
  return "allowed: http:// or https:// with NAME or NAME:PORT and no path";
}

Headers security_headers(const std::string& host) {
  return {{"Content-Security-Policy",
           "default-src 'self'; connect-src 'self' ws://" + host + " wss://" + host +
               "; img-src 'self' data: blob:; object-src 'none'; "
               "base-uri 'none'; form-action 'self'; frame-ancestors 'none'"},
          {"X-Content-Type-Options", "nosniff"},
          {"X-Frame-Options", "DENY"},
          {"Referrer-Policy", "no-referrer"},
          {"Permissions-Policy", "camera=(), geolocation=(), microphone=()"},
          {"Cross-Origin-Resource-Policy", "same-origin"},
          {"Cross-Origin-Opener-Policy", "same-origin"}};
}

Headers cross_origin_headers(const std::string& origin) {
  return {{"Access-Control-Allow-Origin", origin},
          {"Access-Control-Expose-Headers", "Location, Results-Partial, Retry-After"},
          {"Vary", "Origin"}};
}

Headers preflight_headers() {
  return {{"Access-Control-Allow-Methods", "GET, HEAD, POST, PUT, PATCH, DELETE"},
          {"Access-Control-Allow-Headers",
           "Authorization, Content-Type, Idempotency-Key, X-Api-Key, X-Stagger-Client"},
          {"Access-Control-Max-Age", "600"}};
}

}  // namespace stagger::server
