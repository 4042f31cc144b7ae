#include "server/http/connection.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <thread>

namespace stagger::server {
namespace {

using namespace std::chrono_literals;

/// Two sockets that are joined: ours, and the client's.
class Pair {
 public:
  Pair() { EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends_), 0); }
  ~Pair() {
    close(ends_[0]);
    close(ends_[1]);
  }
  int ours() const { return ends_[0]; }
  void client_sends(const std::string& text) const {
    ASSERT_EQ(::write(ends_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  std::string client_gets() const {
    char buffer[65536];
    const ssize_t count = recv(ends_[1], buffer, sizeof buffer, MSG_DONTWAIT);
    return count > 0 ? std::string(buffer, static_cast<std::size_t>(count)) : "";
  }

 private:
  int ends_[2] = {-1, -1};
};

TEST(Connection, AWebSocketFrameLeavesInOnePiece) {
  const Pair pair;
  Connection connection(pair.ours());
  connection.become_websocket();
  connection.write("\x81\x03", 2);
  EXPECT_EQ(pair.client_gets(), "");
  connection.write("abc", 3);
  EXPECT_EQ(pair.client_gets(), std::string("\x81\x03") + "abc");

  const std::string payload(300, 'x');
  connection.write("\x81\x7e", 2);
  connection.write("\x01\x2c", 2);
  EXPECT_EQ(pair.client_gets(), "");
  connection.write(payload.data(), payload.size());
  EXPECT_EQ(pair.client_gets(), "\x81\x7e\x01\x2c" + payload);
}

TEST(Connection, AnEmptyFrameLeavesToo) {
  const Pair pair;
  Connection connection(pair.ours());
  connection.become_websocket();
  connection.write("\x8a\x00", 2);
  EXPECT_EQ(pair.client_gets(), std::string("\x8a\x00", 2));
}

TEST(Connection, NothingFollowsAClose) {
  const Pair pair;
  Connection connection(pair.ours());
  connection.become_websocket();
  EXPECT_TRUE(connection.send_control(Connection::Control::close, std::string("\x03\xe9", 2)));
  EXPECT_EQ(pair.client_gets(), std::string("\x88\x02\x03\xe9", 4));
  EXPECT_EQ(connection.write("\x81\x01z", 3), 3);
  EXPECT_TRUE(connection.send_control(Connection::Control::ping, ""));
  EXPECT_EQ(pair.client_gets(), "");
}

TEST(Connection, AWebSocketReadFillsItsBuffer) {
  const Pair pair;
  Connection connection(pair.ours());
  connection.become_websocket();
  pair.client_sends("a");
  std::thread later([&pair] { pair.client_sends("b"); });
  char buffer[2];
  EXPECT_EQ(connection.read(buffer, 2), 2);
  EXPECT_EQ(std::string(buffer, 2), "ab");
  later.join();
}

TEST(Connection, APlainReadTakesWhatIsThere) {
  const Pair pair;
  Connection connection(pair.ours());
  pair.client_sends("abc");
  EXPECT_TRUE(connection.wait_for_request(1s));
  char buffer[8];
  EXPECT_EQ(connection.read(buffer, 2), 2);
  EXPECT_TRUE(connection.has_buffered());
  EXPECT_EQ(connection.read(buffer, 8), 1);
}

TEST(Connection, AClientThatTakesNothingStallsTheWrite) {
  const Pair pair;
  Connection connection(pair.ours());
  const std::string much(16 << 20, 'x');
  EXPECT_EQ(connection.write(much.data(), much.size()), -1);
  EXPECT_TRUE(connection.stalled());
}

TEST(Connection, AClientThatHasGoneIsNotStalled) {
  Connection connection([] {
    int ends[2];
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    close(ends[1]);
    return ends[0];
  }());
  EXPECT_EQ(connection.write("x", 1), -1);
  EXPECT_FALSE(connection.stalled());
  close(connection.socket());
}

TEST(Connection, ShutDownEndsReadsAndWritesInOtherThreads) {
  const Pair pair;
  Connection connection(pair.ours());
  connection.become_websocket();
  connection.set_read_timeout(60s);
  std::thread reader([&connection] {
    char byte = 0;
    EXPECT_LE(connection.read(&byte, 1), 0);
  });
  connection.shut_down();
  reader.join();
  EXPECT_EQ(connection.write("\x81\x01z", 3), -1);
}

TEST(ConnectionRegistry, ShutsDownAllThatAreOpenAndAllThatComeLater) {
  const Pair first;
  const Pair second;
  ConnectionRegistry registry;
  Connection early(first.ours());
  const ConnectionRegistry::Entry entry(registry, early);
  registry.shut_down_all();
  char byte = 0;
  EXPECT_EQ(early.read(&byte, 1), 0);
  Connection late(second.ours());
  const ConnectionRegistry::Entry other(registry, late);
  EXPECT_EQ(late.read(&byte, 1), 0);
}

}  // namespace
}  // namespace stagger::server
