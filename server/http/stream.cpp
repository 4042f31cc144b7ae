#include "server/http/stream.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <thread>

#include "server/json/stream_data.h"
#include "server/json/stream_json.h"

namespace stagger::server {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::size_t max_message = 64 * 1024;
constexpr int max_mistakes = 10;
constexpr auto heartbeat_period = 1s;
constexpr int heartbeats_per_ping = 3;
// How long a client may take to answer our close before the connection is cut.
constexpr auto close_patience = 500ms;

/// The writer's side of one client.
class StreamWriter {
 public:
  StreamWriter(StreamSocket& socket, FrameHub& hub, Subscriber& subscriber)
      : socket_(socket), hub_(hub), subscriber_(subscriber) {}

  void run() {
    Clock::time_point next_heartbeat = Clock::now() + heartbeat_period;
    while (!subscriber_.finished()) {
      const auto item = subscriber_.next(next_heartbeat);
      if (item && std::holds_alternative<CloseItem>(*item))
        return close(std::get<CloseItem>(*item));
      bool alive = !item || sent(send(*item));
      if (alive && Clock::now() >= next_heartbeat) {
        next_heartbeat = Clock::now() + heartbeat_period;
        alive = beat();
      }
      if (!alive) break;
    }
    socket_.shut_down();
  }

 private:
  StreamSocket::Sent send(const StreamItem& item) {
    const auto* data = std::get_if<DataItem>(&item);
    if (data == nullptr) return socket_.send(text_of(item));
    const std::string& message =
        data_.write(*data->frame, data->subscription, data->seq, data->due);
    const bool is_text = data->subscription->format == StreamFormat::json;
    return is_text ? socket_.send(message) : socket_.send_binary(message);
  }

  const std::string& text_of(const StreamItem& item) {
    if (const auto* session = std::get_if<SessionPtr>(&item)) {
      text_ = hello_text(**session);
    } else if (const auto* event = std::get_if<EventPtr>(&item)) {
      text_ = event_text(**event);
    } else if (const auto* reply = std::get_if<ReplyItem>(&item)) {
      text_ = reply->text;
    }
    return text_;
  }

  bool beat() {
    const FramePtr latest = hub_.latest();
    const std::uint64_t tick = latest ? latest->frame.tick : 0;
    const double time = latest ? latest->frame.time : 0.0;
    if (!sent(socket_.send(heartbeat_text(tick, time, hub_.running(), subscriber_.dropped())))) {
      return false;
    }
    if (++heartbeats_ % heartbeats_per_ping != 0) return true;
    return sent(socket_.ping());
  }

  bool sent(StreamSocket::Sent outcome) {
    if (outcome != StreamSocket::Sent::stalled) return outcome == StreamSocket::Sent::yes;
    spdlog::warn("a stream client took nothing for too long and is disconnected");
    hub_.count_dropped_client();
    return false;
  }

  void close(const CloseItem& item) {
    if (subscriber_.overflowed()) hub_.count_dropped_client();
    socket_.close(item.code, item.reason);
    subscriber_.wait_until_finished(close_patience);
    socket_.shut_down();
  }

  StreamSocket& socket_;
  FrameHub& hub_;
  Subscriber& subscriber_;
  DataWriter data_;
  std::string text_;
  int heartbeats_ = 0;
};

/// True when the client's message was as it should be.
bool answer(const std::string& message, FrameHub& hub, Subscriber& subscriber) {
  if (message.size() > max_message) {
    subscriber.reply(error_text("the message is over 64 KiB"));
    return false;
  }
  const SessionPtr session = hub.session();
  sim::JsonErrors errors;
  Subscription subscription = read_subscription(message, *session, errors);
  if (errors.empty()) {
    std::string text = subscribed_text(subscription, *session);
    subscriber.subscribe(std::move(subscription), std::move(text), hub.latest());
    return true;
  }
  std::string detail;
  for (const sim::JsonError& error : errors.list()) {
    detail += (detail.empty() ? "" : "; ") + error.pointer + (error.pointer.empty() ? "" : " ") +
              error.text;
  }
  subscriber.reply(error_text(detail));
  return false;
}

}  // namespace

void serve_stream(StreamSocket& socket, FrameHub& hub) {
  const std::shared_ptr<Subscriber> subscriber = hub.add();
  std::thread writer([&] { StreamWriter(socket, hub, *subscriber).run(); });
  int mistakes = 0;
  std::string message;
  while (socket.read(message)) {
    if (answer(message, hub, *subscriber)) continue;
    if (++mistakes == max_mistakes) subscriber->close(1008, "messages not understood");
  }
  hub.remove(subscriber);
  subscriber->finish();
  writer.join();
}

}  // namespace stagger::server
