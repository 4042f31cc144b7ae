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
  void client_leaves() {
    close(ends_[1]);
    ends_[1] = -1;
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
  connection.begin_request();
  char buffer[8];
  EXPECT_EQ(connection.read(buffer, 2), 2);
  EXPECT_TRUE(connection.has_buffered());
  EXPECT_EQ(connection.read(buffer, 8), 1);
}

TEST(Connection, KnowsWhenARequestIsWhole) {
  const Pair pair;
  Connection connection(pair.ours());
  EXPECT_EQ(connection.take_in(), Connection::Request::incomplete);
  pair.client_sends("GET / HTTP/1.1\r\nHost: x\r\n\r");
  EXPECT_EQ(connection.take_in(), Connection::Request::incomplete);
  pair.client_sends("\nGET /two HTTP/1.1\r\n\r\n");
  EXPECT_EQ(connection.take_in(), Connection::Request::whole);
  char buffer[28];
  connection.begin_request();
  EXPECT_EQ(connection.read(buffer, 27), 27);
  EXPECT_EQ(connection.take_in(), Connection::Request::whole) << "the next one has come already";
}

TEST(Connection, AHeadThatIsTooLongIsForTheLibraryToRefuse) {
  const Pair pair;
  Connection connection(pair.ours());
  pair.client_sends(std::string(20000, 'x'));
  EXPECT_EQ(connection.take_in(), Connection::Request::begun);
}

TEST(Connection, AShortBodyBelongsToTheRequest) {
  const Pair pair;
  Connection connection(pair.ours());
  const std::string head = "POST / HTTP/1.1\r\nContent-Length: 3\r\n\r\n";
  pair.client_sends(head + "{");
  EXPECT_EQ(connection.take_in(), Connection::Request::incomplete);
  pair.client_sends("}");
  EXPECT_EQ(connection.take_in(), Connection::Request::incomplete);
  pair.client_sends("\n" + head + "[]\nGET / HTTP/1.1\r\n");
  EXPECT_EQ(connection.take_in(), Connection::Request::whole);
  std::string text(head.size() + 3, '\0');
  for (const char* const body : {"{}\n", "[]\n"}) {
    connection.begin_request();
    EXPECT_EQ(connection.read(text.data(), text.size()), static_cast<ssize_t>(text.size()));
    EXPECT_EQ(text, head + body);
    EXPECT_EQ(connection.take_in(),
              body[0] == '{' ? Connection::Request::whole : Connection::Request::incomplete);
  }
}

TEST(Connection, ALongBodyAndOneOfUnknownLengthAreLeftToTheirReader) {
  for (const char* line : {"Content-Length: 16384", "Transfer-Encoding: chunked"}) {
    const Pair pair;
    Connection connection(pair.ours());
    pair.client_sends(std::string("POST / HTTP/1.1\r\n") + line + "\r\n\r\n");
    EXPECT_EQ(connection.take_in(), Connection::Request::begun) << line;
  }
}

TEST(Connection, ABodyThatIsCutShortIsLeftToItsReader) {
  Pair pair;
  Connection connection(pair.ours());
  pair.client_sends("POST / HTTP/1.1\r\nContent-Length: 3\r\n\r\n{");
  EXPECT_EQ(connection.take_in(), Connection::Request::incomplete);
  pair.client_leaves();
  EXPECT_EQ(connection.take_in(), Connection::Request::begun);
}

TEST(Connection, AHeadThatIsCutShortIsGone) {
  Pair pair;
  Connection connection(pair.ours());
  pair.client_sends("GET /");
  pair.client_leaves();
  EXPECT_EQ(connection.take_in(), Connection::Request::gone);
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

TEST(ConnectionRegistry, CutsTheSlowestClientFirst) {
  const Pair first;
  const Pair second;
  ConnectionRegistry registry;
  Connection slow(first.ours());
  Connection slower(second.ours());
  const ConnectionRegistry::Entry entry(registry, slow);
  const ConnectionRegistry::Entry other(registry, slower);
  slower.begin_request();
  std::this_thread::sleep_for(5ms);
  slow.begin_request();
  char byte = 0;
  std::thread reader([&] { EXPECT_EQ(slower.read(&byte, 1), 0) << "cut off"; });
  std::size_t cut = 0;
  while (cut == 0) {
    cut = registry.cut_slowest(5, std::chrono::steady_clock::now());
    std::this_thread::sleep_for(1ms);
  }
  reader.join();
  EXPECT_EQ(cut, 1U) << "who does not wait for its client stays";
}

}  // namespace
}  // namespace stagger::server
