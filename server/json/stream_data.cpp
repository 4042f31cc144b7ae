#include "server/json/stream_data.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace stagger::server {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the stream's binary form is written as it lies in memory");

constexpr char binary_data = 1;  // the kind of a binary message; there is no other yet
constexpr std::size_t header_size = 32;

// The shortest text that reads back as the same number.
template <typename Number>
void append(std::string& text, Number value) {
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(value)) {
      text += "null";
      return;
    }
  }
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value);
  text.append(digits, end.ptr);
}

template <typename Number>
void put_at(std::string& bytes, std::size_t at, Number value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

std::size_t up_to_eight(std::size_t size) { return (size + 7) / 8 * 8; }

bool is_due_in(RateMask due, const ChannelPick& pick) { return ((due >> pick.rate) & 1U) != 0; }

}  // namespace

void append_number(std::string& text, double value) { append(text, value); }

ChannelLayout layout_of(const Subscription& subscription, const SessionInfo& session) {
  ChannelLayout layout;
  for (const sim::Channel& channel : session.channels) {
    const ChannelChoice* choice = nullptr;
    if (subscription.channels) {
      const auto found =
          std::find_if(subscription.channels->begin(), subscription.channels->end(),
                       [&](const ChannelChoice& c) { return c.name == channel.name; });
      if (found == subscription.channels->end()) continue;
      choice = &*found;
    }
    ChannelPick pick;
    pick.channel = &channel;
    pick.rate = choice == nullptr ? 0 : choice->rate;
    const bool all = choice == nullptr || choice->fields.empty();
    for (std::size_t i = 0; i < channel.components.size(); ++i) {
      const std::string& name = channel.components[i].name;
      if (all ||
          std::find(choice->fields.begin(), choice->fields.end(), name) != choice->fields.end()) {
        pick.fields.push_back(i);
      }
    }
    layout.push_back(std::move(pick));
  }
  return layout;
}

void DataWriter::prepare(const FrameMessage& message, const SubscriptionPtr& subscription) {
  if (session_ == message.session && subscription_ == subscription) return;
  session_ = message.session;
  subscription_ = subscription;
  layout_ = layout_of(*subscription_, *session_);
}

void DataWriter::read(const ChannelPick& pick, const sim::Frame& frame) {
  const std::size_t count = pick.channel->components.size();
  values_.clear();
  if (pick.fields.size() == count) {
    pick.channel->read(frame, values_);
  } else {
    all_.clear();
    pick.channel->read(frame, all_);
    for (std::size_t start = 0; start + count <= all_.size(); start += count) {
      for (const std::size_t field : pick.fields) values_.push_back(all_[start + field]);
    }
  }
}

const std::string& DataWriter::write(const FrameMessage& message,
                                     const SubscriptionPtr& subscription, std::uint64_t seq,
                                     RateMask due) {
  prepare(message, subscription);
  switch (subscription->format) {
    case StreamFormat::json:
      write_text(message.frame, seq, due);
      break;
    case StreamFormat::float64:
      write_binary<double>(message.frame, seq, due);
      break;
    case StreamFormat::float32:
      write_binary<float>(message.frame, seq, due);
      break;
  }
  return message_;
}

void DataWriter::write_text(const sim::Frame& frame, std::uint64_t seq, RateMask due) {
  message_ = R"({"op":"data","seq":)";
  append(message_, seq);
  message_ += R"(,"tick":)";
  append(message_, frame.tick);
  message_ += R"(,"t":)";
  append(message_, frame.time);
  message_ += R"(,"v":{)";
  bool first = true;
  for (const ChannelPick& pick : layout_) {
    if (!is_due_in(due, pick)) continue;
    if (!std::exchange(first, false)) message_ += ',';
    message_ += '"' + pick.channel->name + R"(":[)";
    read(pick, frame);
    for (std::size_t i = 0; i < values_.size(); ++i) {
      if (i > 0) message_ += ',';
      append(message_, values_[i]);
    }
    message_ += ']';
  }
  message_ += "}}";
}

template <typename Number>
void DataWriter::write_binary(const sim::Frame& frame, std::uint64_t seq, RateMask due) {
  // How often lists repeat stands before the values, so that these lie where they can be viewed as
  // an array.
  std::size_t lists = 0;
  for (const ChannelPick& pick : layout_) {
    if (is_due_in(due, pick) && pick.channel->max_repeat > 1) ++lists;
  }
  const std::size_t start = up_to_eight(header_size + lists);
  message_.assign(start, '\0');
  std::size_t list = header_size;
  for (const ChannelPick& pick : layout_) {
    if (!is_due_in(due, pick)) continue;
    read(pick, frame);
    if (pick.channel->max_repeat > 1) {
      const std::size_t repeats = pick.fields.empty() ? 0 : values_.size() / pick.fields.size();
      message_[list++] = static_cast<char>(repeats);
      values_.resize(repeats * pick.fields.size());
    } else {
      // A reader counts on hello's length, whatever the frame holds.
      values_.resize(pick.fields.size(), std::numeric_limits<double>::quiet_NaN());
    }
    const std::size_t at = message_.size();
    message_.resize(at + values_.size() * sizeof(Number));
    for (std::size_t i = 0; i < values_.size(); ++i) {
      put_at(message_, at + i * sizeof(Number), static_cast<Number>(values_[i]));
    }
  }
  message_[0] = binary_data;
  message_[1] = static_cast<char>(sizeof(Number));
  put_at(message_, 2, due);
  put_at(message_, 4, static_cast<std::uint32_t>((message_.size() - start) / sizeof(Number)));
  put_at(message_, 8, seq);
  put_at(message_, 16, frame.tick);
  put_at(message_, 24, frame.time);
}

}  // namespace stagger::server
