#include "server/presets/preset_store.h"

#include <gtest/gtest.h>

#include <fstream>

namespace stagger::server {
namespace {

class PresetStoreTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove_all(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  const std::filesystem::path folder_ =
      std::filesystem::path(::testing::TempDir()) /
      ("presets" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
       ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

Preset slow() {
  Preset preset;
  preset.note = "slow and steady";
  preset.parameters = {{"gait.t_ss", 0.7}, {"hip.in_steps", 1.0}};
  preset.strategies.wanted[2] = false;
  return preset;
}

TEST_F(PresetStoreTest, KeepsWhatItIsGivenOverItsOwnEnd) {
  {
    PresetStore store(folder_);
    EXPECT_TRUE(store.names().empty());
    EXPECT_FALSE(std::filesystem::exists(folder_));
    EXPECT_TRUE(store.put("slow", slow()));
    EXPECT_FALSE(store.put("slow", slow()));
    EXPECT_TRUE(store.put("another", Preset()));
  }
  PresetStore store(folder_);
  EXPECT_EQ(store.names(), (std::vector<std::string>{"another", "slow"}));
  const auto found = store.find("slow");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->note, slow().note);
  EXPECT_EQ(found->parameters, slow().parameters);
  EXPECT_EQ(found->strategies.wanted, slow().strategies.wanted);
  EXPECT_TRUE(store.remove("slow"));
  EXPECT_FALSE(store.remove("slow"));
  EXPECT_FALSE(store.find("slow"));
}

TEST_F(PresetStoreTest, NamesNeverLeaveTheFolder) {
  PresetStore store(folder_);
  for (const std::string& name :
       {std::string(), std::string("../x"), std::string("a/b"), std::string(".hidden"),
        std::string("A"), std::string("-x"), std::string(65, 'a'), std::string("a\0b", 3)}) {
    EXPECT_FALSE(PresetStore::is_name(name)) << name;
    EXPECT_THROW(store.put(name, Preset()), PresetError) << name;
    EXPECT_FALSE(store.find(name)) << name;
    EXPECT_FALSE(store.remove(name)) << name;
  }
  EXPECT_TRUE(PresetStore::is_name("0a-b_c"));
}

TEST_F(PresetStoreTest, AFileThatIsNoPresetIsNotThere) {
  std::filesystem::create_directories(folder_);
  std::ofstream(folder_ / "broken.json") << "{\"parameters\":{\"gait.t_ss\":";
  std::ofstream(folder_ / "wrong.json") << R"({"parameters":{"no.such":1}})";
  PresetStore store(folder_);
  EXPECT_FALSE(store.find("broken"));
  EXPECT_FALSE(store.find("wrong"));
  EXPECT_FALSE(store.put("broken", slow()));
  EXPECT_TRUE(store.find("broken"));
}

TEST_F(PresetStoreTest, AFolderThatCannotBeWrittenIsAnError) {
  std::ofstream(folder_) << "a file in the way";
  PresetStore store(folder_);
  EXPECT_THROW(store.put("slow", slow()), PresetError);
}

}  // namespace
}  // namespace stagger::server
