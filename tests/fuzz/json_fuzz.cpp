// JSON bodies, files and stream messages. The first byte chooses who reads the rest.
#include <array>
#include <cstdlib>
#include <functional>

#include "server/campaign/spec.h"
#include "server/json/gait_json.h"
#include "server/json/parameters_json.h"
#include "server/json/push_json.h"
#include "server/json/recording_json.h"
#include "server/json/step_list_json.h"
#include "server/json/stream_json.h"
#include "server/json/terrain_json.h"
#include "server/json/trial_json.h"
#include "server/json/world_json.h"
#include "server/presets/preset_store.h"
#include "sim/json_file.h"
#include "sim/robot/biped_description.h"
#include "tests/fuzz/fuzz.h"

namespace stagger::server {
namespace {

using sim::JsonErrors;
using Reader = std::function<void(const std::string&, JsonErrors&)>;

/// One that reads the fields of an object.
template <typename Read>
Reader fields(Read read) {
  return [read](const std::string& text, JsonErrors& errors) {
    sim::read_json(sim::parse_json(text), errors, [&](sim::JsonReader& in) { read(in); });
  };
}

SessionInfo kasaei_stream() {
  SessionInfo info;
  info.robot = "kasaei";
  info.channels = sim::make_channels({"left_knee"});
  return info;
}

const std::array readers{
    Reader([](const auto& text, auto& errors) { read_trial(sim::parse_json(text), errors); }),
    Reader([](const auto& text, auto& errors) {
      campaign::read_campaign(sim::parse_json(text), errors);
    }),
    Reader([](const auto& text, auto& errors) {
      static const SessionInfo session = kasaei_stream();
      read_subscription(text, session, errors);
    }),
    Reader([](const auto& text, auto& errors) { parse_terrain(text, errors); }),
    Reader([](const auto& text, auto& errors) {
      read_parameter_patch(sim::parse_json(text), errors, "", true);
    }),
    fields([](auto& in) { read_push(in); }),
    fields([](auto& in) { read_walk(in); }),
    fields([](auto& in) { read_strategies(in); }),
    fields([](auto& in) { read_recording_request(in); }),
    fields([](auto& in) { read_recording_patch(in); }),
    fields([](auto& in) { read_step_list(in); }),
    fields([](auto& in) { read_world(in); }),
    fields([](auto& in) { read_command(in); }),
    fields([](auto& in) { read_preset(in); }),
    fields([](auto& in) { sim::read_biped_description(in); }),
};

}  // namespace
}  // namespace stagger::server

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace stagger;
  if (size == 0) return 0;
  const std::string text = testing::text_of(data + 1, size - 1);
  sim::JsonErrors errors;
  try {
    server::readers[data[0] % server::readers.size()](text, errors);
    sim::parse_json(text);  // some readers tell of text that is no JSON as of any other error
  } catch (const sim::JsonSyntaxError&) {
    return 0;
  }
  // Every error in valid JSON is shown with its place.
  for (const sim::JsonError& error : errors.list()) {
    if (sim::position_of(text, error.pointer).line == 0) std::abort();
  }
  return 0;
}
