#include "server/http/security.h"

#include <gtest/gtest.h>

namespace stagger::server {
namespace {

TEST(Security, KnowsLoopback) {
  for (const char* host : {"127.0.0.1", "127.8.9.1", "::1", "localhost"}) {
    EXPECT_TRUE(is_loopback(host)) << host;
  }
  for (const char* host : {"0.0.0.0", "192.168.1.4", "127.0.0.1.evil.com", "127.evil.com",
                           "::", "localhost.evil.com", ""}) {
    EXPECT_FALSE(is_loopback(host)) << host;
  }
}

TEST(Security, LetsItsOwnNamesIn) {
  const Gatekeeper gate("127.0.0.1", 8080);
  for (const char* host : {"127.0.0.1:8080", "localhost:8080", "LocalHost:8080", "[::1]:8080"}) {
    EXPECT_FALSE(gate.refusal(host, "")) << host;
  }
}

TEST(Security, RefusesForeignNamesAndPorts) {
  const Gatekeeper gate("127.0.0.1", 8080);
  for (const char* host :
       {"", "evil.com", "evil.com:8080", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:8081",
        "127.0.0.1:", "127.0.0.1:8080:8080", "127.0.0.1:0008080", "127.0.0.1:+8080",
        "localhost.evil.com:8080", "192.168.1.4:8080", "[::1]8080", "[::1", "127.0.0.1:8080 "}) {
    EXPECT_TRUE(gate.refusal(host, "")) << host;
  }
}

TEST(Security, LeavesTheSchemesOwnPortOut) {
  const Gatekeeper gate("127.0.0.1", 80);
  EXPECT_FALSE(gate.refusal("localhost", "http://localhost"));
  EXPECT_FALSE(gate.refusal("localhost:80", ""));
}

TEST(Security, AnOriginMustBeTheSameHost) {
  const Gatekeeper gate("127.0.0.1", 8080);
  EXPECT_FALSE(gate.refusal("127.0.0.1:8080", "http://127.0.0.1:8080"));
  EXPECT_FALSE(gate.refusal("localhost:8080", "http://localhost:8080"));
  for (const char* origin :
       {"http://evil.com", "null", "https://127.0.0.1:8080", "http://localhost:8080",
        "http://127.0.0.1:8081", "http://127.0.0.1:8080.evil.com", "http://127.0.0.1"}) {
    EXPECT_TRUE(gate.refusal("127.0.0.1:8080", origin)) << origin;
  }
}

// A name server can make any name point anywhere, but not a number.
TEST(Security, ServedToOthersItTakesAddressesAndItsOwnName) {
  const Gatekeeper gate("0.0.0.0", 8080);
  EXPECT_FALSE(gate.refusal("192.168.1.4:8080", ""));
  EXPECT_FALSE(gate.refusal("[fe80::1]:8080", ""));
  EXPECT_TRUE(gate.refusal("evil.com:8080", ""));
  EXPECT_FALSE(Gatekeeper("robot.lan", 8080).refusal("robot.lan:8080", ""));
}

TEST(Security, NamesOnTheListAreLetIn) {
  const Gatekeeper gate("127.0.0.1", 8080, {{"robot.example", "lab:9000"}, {}});
  for (const char* host : {"robot.example", "Robot.Example:80", "robot.example:443", "lab:9000"}) {
    EXPECT_FALSE(gate.refusal(host, "")) << host;
  }
  for (const char* host : {"lab", "lab:9001", "x.robot.example", "robot.example.evil.com"}) {
    EXPECT_TRUE(gate.refusal(host, "")) << host;
  }
  // A proxy before it may speak TLS.
  EXPECT_FALSE(gate.refusal("robot.example", "https://robot.example"));
  EXPECT_TRUE(gate.refusal("robot.example", "https://evil.com"));
}

TEST(Security, OriginsOnTheListAreLetIn) {
  const Gatekeeper gate("127.0.0.1", 8080, {{}, {"https://pages.example"}});
  EXPECT_FALSE(gate.refusal("127.0.0.1:8080", "https://pages.example"));
  EXPECT_TRUE(gate.is_allowed_origin("https://pages.example"));
  for (const char* origin : {"http://pages.example", "https://pages.example:8443", "null", ""}) {
    EXPECT_FALSE(gate.is_allowed_origin(origin)) << origin;
  }
  EXPECT_TRUE(gate.refusal("evil.com", "https://pages.example")) << "the Host still counts";
}

TEST(Security, ListsTakeNamesOnly) {
  for (const char* host : {"robot.example", "robot.example:80", "10.0.0.1", "[::1]:80"}) {
    EXPECT_FALSE(why_no_host(host)) << host;
  }
  for (const char* host : {"", "a b", "*", "http://a", "a:b", "a/b", "a;b", "a\r\nb"}) {
    EXPECT_TRUE(why_no_host(host)) << host;
  }
  EXPECT_FALSE(why_no_origin("https://pages.example"));
  EXPECT_FALSE(why_no_origin("http://pages.example:8000"));
  for (const char* origin :
       {"", "null", "*", "pages.example", "https://", "https://a/b", "ftp://a"}) {
    EXPECT_TRUE(why_no_origin(origin)) << origin;
  }
}

}  // namespace
}  // namespace stagger::server
