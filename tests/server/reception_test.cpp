#include "server/http/reception.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <vector>

namespace stagger::server {
namespace {

using namespace std::chrono_literals;

/// A client whose other end is a guest's.
class Client {
 public:
  Client() {
    int ends[2];
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    socket_ = ends[0];
    connection_ = Reception::ConnectionPtr(new Connection(ends[1]), [](Connection* connection) {
      close(connection->socket());
      delete connection;
    });
  }
  ~Client() { close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  Reception::ConnectionPtr take_connection() { return std::move(connection_); }
  void say(const std::string& text) const {
    EXPECT_EQ(::write(socket_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  /// Waits until the server has let go: by an end, or by a reset when it had not read all.
  bool is_dismissed() const {
    char byte = 0;
    return recv(socket_, &byte, 1, 0) <= 0;
  }

 private:
  int socket_ = -1;
  Reception::ConnectionPtr connection_;
};

class ReceptionTest : public ::testing::Test {
 protected:
  void serve(Reception::ConnectionPtr connection) {
    const std::lock_guard lock(mutex_);
    served_.push_back(std::move(connection));
    changed_.notify_all();
  }
  bool wait_for_served(std::size_t count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, 30s, [&] { return served_.size() >= count; });
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Reception::ConnectionPtr> served_;
  std::atomic<int> turns_{0};
  Reception reception_{2, [this](auto connection, auto) { serve(std::move(connection)); },
                       [this] { ++turns_; }};
};

TEST_F(ReceptionTest, HandsOverWhoHasAskedForSomething) {
  Client client;
  client.say("GET / HTTP/1.1\r\n");
  reception_.await_request(client.take_connection());
  client.say("\r\n");
  EXPECT_TRUE(wait_for_served(1));
}

TEST_F(ReceptionTest, ARequestThatHasComeAlreadyIsSeen) {
  Client client;
  client.say("GET / HTTP/1.1\r\n\r\n");
  reception_.await_request(client.take_connection());
  EXPECT_TRUE(wait_for_served(1));
}

TEST_F(ReceptionTest, WhoHasWaitedLongestMakesRoom) {
  Client first;
  Client second;
  Client third;
  for (Client* client : {&first, &second, &third}) {
    client->say("GET ");
    reception_.await_request(client->take_connection());
  }
  EXPECT_TRUE(first.is_dismissed());
  second.say("/ HTTP/1.1\r\n\r\n");
  third.say("/ HTTP/1.1\r\n\r\n");
  EXPECT_TRUE(wait_for_served(2));
}

TEST_F(ReceptionTest, WhatDrainsIsNeverServed) {
  Client client;
  reception_.drain(client.take_connection());
  client.say("GET / HTTP/1.1\r\n\r\n");
  EXPECT_TRUE(client.is_dismissed()) << "after the patience for it";
  EXPECT_TRUE(served_.empty());
  EXPECT_GT(turns_, 0);
}

TEST_F(ReceptionTest, LetsGoOfAllAtTheEnd) {
  Client early;
  Client late;
  reception_.await_request(early.take_connection());
  reception_.stop();
  reception_.await_request(late.take_connection());
  EXPECT_TRUE(early.is_dismissed());
  EXPECT_TRUE(late.is_dismissed());
}

}  // namespace
}  // namespace stagger::server
