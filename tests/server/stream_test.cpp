#include "server/http/stream.h"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

namespace stagger::server {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

/// A client that lives in the test.
class FakeSocket final : public StreamSocket {
 public:
  bool read(std::string& text) override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return ended_ || !incoming_.empty(); });
    if (ended_) return false;
    text = incoming_.front();
    incoming_.pop_front();
    return true;
  }
  Sent send(const std::string& text) override {
    if (stalls) return Sent::stalled;
    const std::lock_guard lock(mutex_);
    if (ended_) return Sent::gone;
    outgoing_.push_back(json::parse(text));
    changed_.notify_all();
    return Sent::yes;
  }
  Sent send_binary(const std::string& bytes) override {
    const std::lock_guard lock(mutex_);
    outgoing_.push_back({{"op", "binary"}, {"size", bytes.size()}});
    changed_.notify_all();
    return Sent::yes;
  }
  Sent ping() override { return Sent::yes; }
  void close(int code, const std::string&) override {
    const std::lock_guard lock(mutex_);
    close_code_ = code;
    changed_.notify_all();
  }
  void shut_down() override {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_all();
  }

  void say(const std::string& text) {
    const std::lock_guard lock(mutex_);
    incoming_.push_back(text);
    changed_.notify_all();
  }
  /// The next message of that kind; those before it are thrown away.
  json next(const std::string& op) {
    std::unique_lock lock(mutex_);
    for (;;) {
      const bool come =
          changed_.wait_for(lock, 30s, [this] { return ended_ || !outgoing_.empty(); });
      if (!come || outgoing_.empty()) return {};
      json message = outgoing_.front();
      outgoing_.pop_front();
      if (message["op"] == op) return message;
    }
  }
  int close_code() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, 30s, [this] { return close_code_ != 0; });
    return close_code_;
  }

  std::atomic<bool> stalls = false;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::string> incoming_;
  std::deque<json> outgoing_;
  int close_code_ = 0;
  bool ended_ = false;
};

class StreamTest : public ::testing::Test {
 protected:
  StreamTest() {
    hub_.start_session(session_);
    server_ = std::thread([this] { serve_stream(socket_, hub_); });
  }
  ~StreamTest() override {
    socket_.shut_down();
    server_.join();
  }
  static SessionPtr make_session(const std::string& id) {
    auto session = std::make_shared<SessionInfo>();
    session->id = id;
    session->channels = sim::make_channels({});
    return session;
  }
  void publish(std::uint64_t tick) {
    auto frame = std::make_shared<FrameMessage>();
    frame->session = session_;
    frame->frame.tick = tick;
    hub_.publish(FramePtr(std::move(frame)), false);
  }

  SessionPtr session_ = make_session("one");
  FrameHub hub_;
  FakeSocket socket_;
  std::thread server_;
};

TEST_F(StreamTest, SaysHelloAnswersAndSendsData) {
  EXPECT_EQ(socket_.next("hello")["session_id"], "one");
  socket_.say(R"({"op":"subscribe","rate_hz":1000,"channels":["dcm"]})");
  EXPECT_EQ(socket_.next("subscribed")["channels"], json::array({"dcm"}));
  publish(1);
  const json data = socket_.next("data");
  EXPECT_EQ(data["tick"], 1);
  EXPECT_EQ(data["v"].size(), 1U);
}

TEST_F(StreamTest, SendsDataAsBytesToThoseWhoAskForThem) {
  socket_.say(R"({"op":"subscribe","rate_hz":1000,"channels":["dcm"],"format":"float32"})");
  EXPECT_EQ(socket_.next("subscribed")["format"], "float32");
  publish(1);
  EXPECT_EQ(socket_.next("binary")["size"], 32 + 2 * 4);
}

TEST_F(StreamTest, SaysHelloAgainWhenTheSessionChanges) {
  socket_.next("hello");
  session_ = make_session("two");
  hub_.start_session(session_);
  EXPECT_EQ(socket_.next("hello")["session_id"], "two");
}

TEST_F(StreamTest, SendsHeartbeatsToThoseWhoHaveNotSubscribed) {
  EXPECT_EQ(socket_.next("heartbeat")["running"], true);
}

TEST_F(StreamTest, AMistakeIsAnsweredAndForgiven) {
  socket_.say("nonsense");
  EXPECT_FALSE(socket_.next("error")["detail"].get<std::string>().empty());
  socket_.say(std::string(65 * 1024, ' '));
  EXPECT_EQ(socket_.next("error")["detail"], "the message is over 64 KiB");
  socket_.say(R"({"op":"subscribe"})");
  EXPECT_EQ(socket_.next("subscribed")["rate_hz"], 60.0);
}

TEST_F(StreamTest, ManyMistakesAreNot) {
  for (int i = 0; i < 10; ++i) socket_.say("nonsense");
  EXPECT_EQ(socket_.close_code(), 1008);
}

TEST_F(StreamTest, TheEndIsAnnounced) {
  hub_.close_all(1001, "the server stops");
  EXPECT_EQ(socket_.close_code(), 1001);
}

TEST_F(StreamTest, AClientThatTakesNothingIsDisconnectedAndCounted) {
  socket_.next("hello");
  socket_.stalls = true;
  socket_.say(R"({"op":"subscribe"})");
  for (int i = 0; i < 3000 && hub_.counters().dropped_clients == 0; ++i) {
    std::this_thread::sleep_for(10ms);
  }
  EXPECT_EQ(hub_.counters().dropped_clients, 1U);
}

}  // namespace
}  // namespace stagger::server
