// Who is in a shared folder.
#include "server/presence.h"

#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <random>

namespace stagger::server {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class PresenceTest : public ::testing::Test {
 protected:
  PresenceTest()
      : folder_(fs::temp_directory_path() /
                ("stagger-presence-test-" + std::to_string(std::random_device{}()))) {}
  ~PresenceTest() override { fs::remove_all(folder_); }

  fs::path folder_;
};

TEST_F(PresenceTest, IsThereAsLongAsItLives) {
  const Presence one(folder_);
  auto other = std::make_unique<Presence>(folder_);
  const std::string name = other->name();
  EXPECT_NE(name, one.name());
  EXPECT_TRUE(one.is_there(name));
  EXPECT_TRUE(one.is_another(name));
  EXPECT_TRUE(one.is_there(one.name()));
  EXPECT_FALSE(one.is_another(one.name()));
  EXPECT_FALSE(one.is_there(""));
  EXPECT_FALSE(one.is_there("nobody"));
  other.reset();
  EXPECT_FALSE(one.is_there(name));
}

TEST_F(PresenceTest, WhatADeadOneLeavesIsClearedAway) {
  fs::create_directories(folder_ / "servers");
  std::ofstream(folder_ / "servers" / "dead") << "";
  const Presence one(folder_);
  EXPECT_FALSE(fs::exists(folder_ / "servers" / "dead"));
  EXPECT_FALSE(one.is_there("dead"));
  const Presence other(folder_);
  EXPECT_TRUE(other.is_there(one.name()));
}

TEST_F(PresenceTest, ALockIsHeldByOneAtATime) {
  fs::create_directories(folder_);
  const fs::path file = folder_ / "lock";
  EXPECT_FALSE(FileLock::is_held(file));
  {
    const auto held = FileLock::take(file);
    ASSERT_TRUE(held);
    EXPECT_TRUE(FileLock::is_held(file));
    EXPECT_FALSE(FileLock::take(file, 20ms));
  }
  EXPECT_FALSE(FileLock::is_held(file));
  EXPECT_TRUE(FileLock::take(file));
  EXPECT_THROW(FileLock::take(folder_ / "no folder" / "lock"), std::system_error);
}

}  // namespace
}  // namespace stagger::server
