#include "server/child_process.h"

#include <gtest/gtest.h>

#include <csignal>
#include <thread>

namespace stagger::server {
namespace {

using namespace std::chrono_literals;

ChildOptions shell(const std::string& script) {
  ChildOptions options;
  options.program = "/bin/sh";
  options.arguments = {"-c", script};
  options.folder = "/";
  return options;
}

const std::atomic<bool> never{false};

TEST(ChildProcess, TellsWhatTheProgramWroteAndItsCode) {
  const ChildResult result = run_child(shell("pwd; echo wrong >&2; exit 3"), never);
  EXPECT_EQ(result.end, ChildResult::End::exited);
  EXPECT_EQ(result.code, 3);
  EXPECT_EQ(result.out, "/\n");
  EXPECT_EQ(result.err, "wrong\n");
}

TEST(ChildProcess, NoFileOfOursIsOpenThereAndNoSignalBlocked) {
  const ChildResult result = run_child(
      shell("cat; ls /proc/$$/fd | wc -l; grep SigBlk /proc/$$/status | tr -d '\\t'"), never);
  // Standard input, output and error; a shell may hold one more.
  EXPECT_LE(std::stoi(result.out), 4) << result.out;
  EXPECT_NE(result.out.find("SigBlk:0000000000000000"), std::string::npos) << result.out;
}

TEST(ChildProcess, ItIsKilledWhenItsTimeIsUp) {
  ChildOptions options = shell("sleep 1000");
  options.patience = 50ms;
  EXPECT_EQ(run_child(options, never).end, ChildResult::End::too_long);
}

TEST(ChildProcess, ItIsKilledWhenItWritesTooMuch) {
  ChildOptions options = shell("while :; do echo much; done");
  options.output = 10000;
  const ChildResult result = run_child(options, never);
  EXPECT_EQ(result.end, ChildResult::End::too_long);
  EXPECT_LT(result.out.size(), 200000U);
}

TEST(ChildProcess, ItIsKilledWhenWeStop) {
  std::atomic<bool> stop{false};
  std::thread later([&stop] {
    std::this_thread::sleep_for(50ms);
    stop = true;
  });
  EXPECT_EQ(run_child(shell("sleep 1000"), stop).end, ChildResult::End::stopped);
  later.join();
}

TEST(ChildProcess, ASignalOfItsOwnIsTold) {
  const ChildResult result = run_child(shell("kill -SEGV $$"), never);
  EXPECT_EQ(result.end, ChildResult::End::killed);
  EXPECT_EQ(result.code, SIGSEGV);
}

TEST(ChildProcess, AProgramThatIsNotThereIsAnError) {
  ChildOptions options = shell("");
  options.program = "/no/such/program";
  EXPECT_THROW(run_child(options, never), std::runtime_error);
}

}  // namespace
}  // namespace stagger::server
