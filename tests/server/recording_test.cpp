// From the simulation thread's calls to the file and back, without a server.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "server/recording/export.h"
#include "server/recording/mcap_cut.h"
#include "server/recording/recorder.h"
#include "server/recording/recording_reader.h"
#include "server/recording/repair.h"
#include "server/recording/replay.h"
#include "sim/simulation.h"
#include "tests/sim/kasaei.h"

namespace stagger::server {
namespace {

namespace fs = std::filesystem;
using sim::kasaei;

sim::PushSpec push_of(double impulse_ns) {
  sim::PushSpec push;
  push.impulse_ns = impulse_ns;
  return push;
}

/// A world and a recorder that is told of it, without threads of a live session.
class RecordingTest : public ::testing::Test {
 protected:
  RecordingTest()
      : folder_(fs::temp_directory_path() /
                ("stagger-recording-test-" + std::to_string(std::random_device{}()))),
        presence_(folder_) {}
  ~RecordingTest() override { fs::remove_all(folder_); }

  void start_world(Recorder& recorder, std::uint64_t seed = 1) {
    sim::SimulationConfig config;
    config.robot = kasaei();
    config.plant = sim::PlantKind::lipm;
    config.seed = seed;
    world_ = std::make_unique<sim::Simulation>(config);
    auto session = std::make_shared<SessionInfo>();
    session->id = "session-" + std::to_string(seed);
    session->robot = "kasaei";
    session->plant = config.plant;
    session->seed = seed;
    session->channels = world_->channels();
    session->config = config;
    session->journal = std::make_shared<Journal>();
    session_ = session;
    recorder.start_session(session_);
  }

  void command(const sim::WorldCommand& command) {
    sim::apply(*world_, command);
    session_->journal->add(world_->next_tick(), command);
  }

  void run(Recorder& recorder, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      recorder.await_room(std::chrono::milliseconds(1000));
      world_->step();
      auto frame = std::make_shared<FrameMessage>();
      frame->session = session_;
      frame->frame = world_->frame();
      frame->state_hash = world_->state_hash();
      recorder.tick(frame);
      for (const sim::Event& event : world_->take_events()) {
        auto message = std::make_shared<EventMessage>();
        message->tick = event.tick;
        message->time = event.time;
        message->kind = event.kind == sim::EventKind::push_started ? "push_started" : "step";
        message->text = event.text;
        recorder.event(message);
      }
    }
  }

  /// The selection as a file; what is wrong with it is an error.
  fs::path cut_of(const fs::path& file, const Selection& selection) const {
    sim::JsonErrors errors;
    McapCut cut(file, selection, errors);
    EXPECT_TRUE(errors.empty());
    std::string bytes;
    while (cut.next(bytes)) {
    }
    const fs::path made = folder_ / "made.mcap";
    std::ofstream(made, std::ios::binary) << bytes;
    return made;
  }

  static std::vector<RecordedTick> ticks_of(const fs::path& file) {
    std::vector<RecordedTick> ticks;
    RecordingReader reader(file);
    while (const auto item = reader.next()) {
      if (const auto* tick = std::get_if<RecordedTick>(&*item)) ticks.push_back(*tick);
    }
    return ticks;
  }

  /// A recording of two worlds, 600 and 400 ticks long, with commands.
  fs::path two_worlds(Recorder& recorder) {
    start_world(recorder);
    command(sim::Walk{{.vx = 0.1}});
    run(recorder, 200);
    const std::string id = recorder.start({}).id;
    run(recorder, 200);
    command(sim::StartPush{push_of(2.0)});
    run(recorder, 200);
    start_world(recorder, 2);
    command(sim::Walk{});
    run(recorder, 400);
    recorder.stop(id);
    return recorder.file_of(id);
  }

  static RobotFinder finder() {
    return [](const std::string& name) { return name == "kasaei" ? kasaei() : nullptr; };
  }

  fs::path folder_;
  Presence presence_;
  std::unique_ptr<sim::Simulation> world_;
  SessionPtr session_;
};

TEST_F(RecordingTest, WhatIsReadBackIsWhatHappened) {
  Recorder recorder({folder_}, presence_);
  const fs::path file = two_worlds(recorder);
  RecordingReader reader(file);
  std::vector<std::uint64_t> ticks;
  std::vector<std::string> commands;
  std::size_t worlds = 0;
  RecordedTick last;
  std::uint64_t time_ns = 0;
  while (const auto item = reader.next()) {
    if (const auto* tick = std::get_if<RecordedTick>(&*item)) {
      EXPECT_GT(tick->time_ns, time_ns);
      time_ns = tick->time_ns;
      ticks.push_back(tick->frame.tick);
      last = *tick;
    } else if (const auto* text = std::get_if<RecordedText>(&*item)) {
      if (text->is_command) commands.push_back(text->text);
    } else {
      ++worlds;
    }
  }
  EXPECT_EQ(worlds, 2U);
  ASSERT_EQ(ticks.size(), 800U);
  EXPECT_EQ(ticks.front(), 200U);
  EXPECT_EQ(ticks[399], 599U);
  EXPECT_EQ(ticks.back(), 399U);
  EXPECT_EQ(commands.size(), 3U);  // that of before the recording began is there too
  EXPECT_EQ(last.frame.state_hash, world_->state_hash());
  for (std::size_t i = 0; i < last.schema->channels().size(); ++i) {
    const std::string& name = last.schema->channels()[i].name;
    std::vector<double> expected;
    sim::find_channel(world_->channels(), name)->read(world_->frame(), expected);
    EXPECT_EQ(last.frame.values[i], expected) << name;
  }
}

TEST_F(RecordingTest, ReplaysToTheBitAndTellsADifference) {
  Recorder recorder({folder_}, presence_);
  const fs::path file = two_worlds(recorder);
  const auto worlds = replay(file, finder());
  ASSERT_EQ(worlds.size(), 2U);
  EXPECT_EQ(worlds[0].ticks, 400U);
  EXPECT_EQ(worlds[0].commands, 2U);
  EXPECT_FALSE(worlds[0].difference);
  EXPECT_FALSE(worlds[1].difference);
  EXPECT_TRUE(worlds[0].warnings.empty());

  // What nobody has told the journal of is a difference, at the tick in which it began to act.
  start_world(recorder, 3);
  command(sim::Walk{});
  const std::string id = recorder.start({}).id;
  run(recorder, 100);
  world_->push(push_of(5.0));
  run(recorder, 100);
  recorder.stop(id);
  const auto changed = replay(recorder.file_of(id), finder());
  ASSERT_EQ(changed.size(), 1U);
  ASSERT_TRUE(changed[0].difference);
  EXPECT_EQ(changed[0].difference->tick, 100U);
  ASSERT_TRUE(changed[0].difference->largest);
  EXPECT_EQ(changed[0].difference->largest->unit, "N");
  EXPECT_THROW(replay(file, [](const auto&) { return nullptr; }), std::runtime_error);
}

TEST_F(RecordingTest, APartIsARecordingThatReplays) {
  Recorder recorder({folder_}, presence_);
  const fs::path file = two_worlds(recorder);
  const auto whole = ticks_of(file);
  Selection selection;
  selection.from_s = 0.1;
  selection.every = 7;
  selection.fields = {"preview[1].x", "com.y", "zmp", "com.x", "preview[1].side"};
  const fs::path part = cut_of(file, selection);
  EXPECT_TRUE(is_finished(part));
  const auto ticks = ticks_of(part);
  ASSERT_EQ(ticks.size(), 100U);
  const auto& channels = ticks.front().schema->channels();
  ASSERT_EQ(channels.size(), 3U);
  EXPECT_EQ(channels[0].name, "preview[1]");
  EXPECT_EQ(channels[1].name, "com");
  ASSERT_EQ(channels[1].components.size(), 2U);
  EXPECT_EQ(channels[1].components[0].name, "y");
  EXPECT_EQ(channels[1].components[0].unit, "m");
  EXPECT_EQ(channels[2].components.size(), 2U);
  const auto& table = whole.front().schema->channels();
  const auto com = std::find_if(table.begin(), table.end(),
                                [](const auto& channel) { return channel.name == "com"; }) -
                   table.begin();
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const RecordedTick& same = whole[100 + 7 * i];
    EXPECT_EQ(ticks[i].time_ns, same.time_ns);
    EXPECT_EQ(ticks[i].frame.tick, same.frame.tick);
    EXPECT_EQ(ticks[i].frame.state_hash, same.frame.state_hash);
    EXPECT_EQ(ticks[i].frame.values[1],
              (std::vector{same.frame.values[com][1], same.frame.values[com][0]}));
  }
  const auto worlds = replay(part, finder());
  ASSERT_EQ(worlds.size(), 2U);
  EXPECT_EQ(worlds[0].ticks + worlds[1].ticks, 100U);
  EXPECT_EQ(worlds[0].commands, 2U);
  EXPECT_FALSE(worlds[0].difference);
  EXPECT_FALSE(worlds[1].difference);

  // Of the second world alone: nothing is known of the first, and nobody says that it is equal.
  selection = {};
  selection.from_s = 0.5;
  const auto later = replay(cut_of(file, selection), finder());
  EXPECT_EQ(later[0].ticks, 0U);
  EXPECT_GE(later[1].ticks, 300U);  // its log time is not before the wall's
  selection.from_s = 1e300;
  EXPECT_THROW(replay(cut_of(file, selection), finder()), std::runtime_error);

  selection = {};
  selection.fields = {"comm"};
  sim::JsonErrors errors;
  const McapCut refused(file, selection, errors);
  EXPECT_FALSE(errors.empty());
}

TEST_F(RecordingTest, APartTellsADifferenceByTheNumbersThatItHas) {
  Recorder recorder({folder_}, presence_);
  start_world(recorder);
  const std::string id = recorder.start({}).id;
  run(recorder, 100);
  world_->push(push_of(5.0));  // nobody has told the journal
  run(recorder, 100);
  recorder.stop(id);
  Selection selection;
  selection.every = 30;
  selection.fields = {"push_force.y", "com.x"};
  const auto worlds = replay(cut_of(recorder.file_of(id), selection), finder());
  ASSERT_TRUE(worlds.front().difference);
  EXPECT_EQ(worlds.front().difference->tick, 120U);
  ASSERT_TRUE(worlds.front().difference->largest);
  EXPECT_EQ(worlds.front().difference->largest->number, "com.x");
}

TEST_F(RecordingTest, OneThatIsNotFinishedIsReadAsFarAsItIsWritten) {
  Recorder recorder({folder_}, presence_);
  start_world(recorder);
  command(sim::Walk{});
  const std::string id = recorder.start({}).id;
  run(recorder, 300);
  recorder.stop(recorder.start({}).id);  // what is under way is written now
  run(recorder, 100);
  const fs::path file = recorder.file_of(id);
  EXPECT_FALSE(is_finished(file));
  EXPECT_GE(ticks_of(file).size(), 300U);
  const fs::path part = cut_of(file, {});
  EXPECT_TRUE(is_finished(part));
  EXPECT_GE(ticks_of(part).size(), 300U);
  EXPECT_FALSE(replay(part, finder()).front().difference);
  RecordingRequest armed;
  armed.on_push = true;
  EXPECT_THROW(recorder.file_of(recorder.start(armed).id), CommandError);
}

TEST_F(RecordingTest, WhatAnotherServerIsAtIsLeftAlone) {
  Recorder recorder({folder_}, presence_);
  start_world(recorder);
  RecordingRequest request;
  request.on_push = true;
  const std::string armed = recorder.start(request).id;
  const std::string active = recorder.start({}).id;
  run(recorder, 100);
  const Presence other(folder_);
  {
    Recorder second({folder_}, other);
    EXPECT_EQ(second.find(armed).state, RecordingState::armed);
    EXPECT_EQ(second.find(active).state, RecordingState::recording);
    EXPECT_THROW(second.stop(armed), CommandError);
    EXPECT_THROW(second.stop(active), CommandError);
    EXPECT_THROW(second.remove(active), CommandError);
  }
  command(sim::StartPush{push_of(2.0)});
  run(recorder, 100);
  EXPECT_EQ(recorder.stop(armed).pushes, 1U);
  EXPECT_EQ(recorder.stop(active).ticks, 200U);
  EXPECT_EQ(recorder.find(armed).state, RecordingState::done);
}

TEST_F(RecordingTest, AnOlderCatalogueGetsItsColumnAndKeepsItsNotes) {
  std::string id;
  {
    Recorder recorder({folder_}, presence_);
    id = two_worlds(recorder).stem().string();
    RecordingPatch patch;
    patch.note = "kept";
    recorder.change(id, patch);
  }
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open((folder_ / "recordings.sqlite").c_str(), &database), SQLITE_OK);
  EXPECT_EQ(
      sqlite3_exec(database, "ALTER TABLE recordings DROP COLUMN owner", nullptr, nullptr, nullptr),
      SQLITE_OK);
  sqlite3_close(database);
  Recorder again({folder_}, presence_);
  EXPECT_EQ(again.find(id).note, "kept");
  again.stop(again.start({}).id);
}

TEST_F(RecordingTest, AFileCutAnywhereIsReadAndFinished) {
  fs::path whole;
  {
    Recorder recorder({folder_}, presence_);
    whole = two_worlds(recorder);
  }
  const auto size = fs::file_size(whole);
  const RecordingInfo all = summary_of(whole);
  EXPECT_EQ(all.ticks, 800U);
  std::mt19937 random(1);
  std::uint64_t most = 0;
  for (int i = 0; i < 20; ++i) {
    const fs::path cut = folder_ / "cut.mcap";
    fs::copy_file(whole, cut, fs::copy_options::overwrite_existing);
    fs::resize_file(cut, std::uniform_int_distribution<std::uintmax_t>(0, size)(random));
    RecordingInfo before;
    try {
      before = summary_of(cut);
    } catch (const std::runtime_error&) {
      continue;  // not even its head is there
    }
    repair_mcap(cut);
    EXPECT_TRUE(is_finished(cut));
    const RecordingInfo after = summary_of(cut);
    EXPECT_GE(after.ticks, before.ticks);
    most = std::max(most, after.ticks);
    if (after.ticks > 0) {
      EXPECT_FALSE(replay(cut, finder()).front().difference);
    } else {
      EXPECT_THROW(replay(cut, finder()), std::runtime_error);
    }
  }
  EXPECT_GT(most, 0U);
}

TEST_F(RecordingTest, BytesAtRandomHarmNobody) {
  fs::path whole;
  {
    Recorder recorder({folder_}, presence_);
    whole = two_worlds(recorder);
  }
  std::ifstream in(whole, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  std::mt19937 random(2);
  const fs::path broken = folder_ / "broken.mcap";
  for (int i = 0; i < 60; ++i) {
    std::string changed = bytes;
    for (int n = 0; n < 8; ++n) {
      // The head more often than the rest: that is where the structure is.
      const std::size_t range =
          n % 2 == 0 ? std::min<std::size_t>(changed.size(), 4096) : changed.size();
      changed[random() % range] = static_cast<char>(random());
    }
    std::ofstream(broken, std::ios::binary) << changed;
    try {
      summary_of(broken);
      repair_mcap(broken);
      sim::JsonErrors errors;
      Export text(broken, ExportFormat::ndjson, {}, errors);
      std::string out;
      while (text.next(out)) out.clear();
      Selection some;
      some.every = 3;
      McapCut part(broken, some, errors);
      while (part.next(out)) out.clear();
    } catch (const std::runtime_error&) {
    }
  }
}

TEST_F(RecordingTest, TheCatalogueIsMadeAgainFromTheFiles) {
  std::string id;
  {
    Recorder recorder({folder_}, presence_);
    id = two_worlds(recorder).stem().string();
    RecordingPatch patch;
    patch.note = "kept";
    patch.is_protected = true;
    recorder.change(id, patch);
  }
  {
    Recorder again({folder_}, presence_);
    EXPECT_EQ(again.find(id).note, "kept");
    EXPECT_TRUE(again.find(id).is_protected);
  }
  std::ofstream(folder_ / "recordings.sqlite", std::ios::trunc)
      << "no database at all, but long enough";
  {
    Recorder again({folder_}, presence_);
    const RecordingInfo info = again.find(id);
    EXPECT_EQ(info.ticks, 800U);
    EXPECT_EQ(info.worlds, 2U);
    EXPECT_EQ(info.robot, "kasaei");
    EXPECT_EQ(info.pushes, 1U);
    again.remove(id);
  }
  Recorder again({folder_}, presence_);
  EXPECT_TRUE(again.list({}).empty());
}

TEST_F(RecordingTest, TheFlightRecorderHoldsAMinute) {
  Recorder recorder({folder_}, presence_);
  start_world(recorder);
  run(recorder, 80000);
  RecordingRequest request;
  request.before_s = 60.0;
  request.after_s = 0.0;
  const RecordingInfo info = recorder.start(request);
  EXPECT_EQ(info.state, RecordingState::done);
  EXPECT_GE(info.ticks, 60000U);
  EXPECT_LT(info.ticks, 75000U);
  EXPECT_EQ(info.lost_ticks, 0U);
}

TEST_F(RecordingTest, LostTicksAreCountedAndTold) {
  Recorder recorder({folder_}, presence_);
  start_world(recorder);
  const std::string id = recorder.start({}).id;
  run(recorder, 100);
  for (int i = 0; i < 50; ++i) world_->step();  // nobody is told of these
  run(recorder, 100);
  const RecordingInfo info = recorder.stop(id);
  EXPECT_EQ(info.ticks, 200U);
  EXPECT_EQ(info.lost_ticks, 50U);
  EXPECT_EQ(summary_of(recorder.file_of(id)).lost_ticks, 50U);
  EXPECT_FALSE(replay(recorder.file_of(id), finder()).front().difference);
}

}  // namespace
}  // namespace stagger::server
