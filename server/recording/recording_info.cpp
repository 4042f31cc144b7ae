#include "server/recording/recording_info.h"

#include <array>
#include <utility>

namespace stagger::server {
namespace {

constexpr std::array<std::pair<std::string_view, RecordingState>, 3> states{
    {{"armed", RecordingState::armed},
     {"recording", RecordingState::recording},
     {"done", RecordingState::done}}};
constexpr std::array<std::pair<std::string_view, RecordingReason>, 3> reasons{
    {{"manual", RecordingReason::manual},
     {"push", RecordingReason::push},
     {"fall", RecordingReason::fall}}};

template <typename Table, typename Value>
std::string_view name_in(const Table& table, Value value) {
  for (const auto& [name, known] : table) {
    if (known == value) return name;
  }
  return "";
}

template <typename Value, std::size_t n>
std::optional<Value> value_in(const std::array<std::pair<std::string_view, Value>, n>& table,
                              std::string_view name) {
  for (const auto& [known, value] : table) {
    if (known == name) return value;
  }
  return std::nullopt;
}

}  // namespace

std::string_view name_of(RecordingState state) { return name_in(states, state); }
std::string_view name_of(RecordingReason reason) { return name_in(reasons, reason); }
std::optional<RecordingState> recording_state_of(std::string_view name) {
  return value_in(states, name);
}
std::optional<RecordingReason> recording_reason_of(std::string_view name) {
  return value_in(reasons, name);
}

}  // namespace stagger::server
