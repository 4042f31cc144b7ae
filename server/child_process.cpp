#include "server/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>

namespace stagger::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int look_up_ms = 50;  // how often to see whether we are to stop

[[noreturn]] void fail(int error, const std::string& what) {
  throw std::runtime_error(what + ": " + std::generic_category().message(error));
}

/// Both ends of a pipe, closed with this object.
class Pipe {
 public:
  Pipe() {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0) fail(errno, "cannot make a pipe");
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int read_end() const { return ends_[0]; }
  int write_end() const { return ends_[1]; }
  void close_end(std::size_t which) {
    if (ends_[which] >= 0) close(ends_[which]);
    ends_[which] = -1;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

pid_t start(const ChildOptions& options, const Pipe& out, const Pipe& err) {
  const std::string program = options.program.string();
  std::vector<std::string> words{program};
  words.insert(words.end(), options.arguments.begin(), options.arguments.end());
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, out.write_end(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, err.write_end(), STDERR_FILENO);
  posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
  posix_spawn_file_actions_addchdir_np(&files, options.folder.c_str());
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // Our own threads block signals that must still reach the child.
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);

  pid_t child = 0;
  const int error =
      posix_spawn(&child, program.c_str(), &files, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) fail(error, "cannot start " + program);
  return child;
}

/// Takes what has come; false at the end of the stream.
bool take(int descriptor, std::string& text) {
  std::array<char, 65536> buffer;
  const ssize_t count = read(descriptor, buffer.data(), buffer.size());
  if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
  return count > 0 || (count < 0 && errno == EINTR);
}

/// Reads both streams until the child has closed them; tells why it was not waited for any longer.
ChildResult::End read_all(const ChildOptions& options, const std::atomic<bool>& stop,
                          const Pipe& out, const Pipe& err, ChildResult& result) {
  const auto end = Clock::now() + options.patience;
  std::array<pollfd, 2> streams{{{out.read_end(), POLLIN, 0}, {err.read_end(), POLLIN, 0}}};
  const std::array<std::string*, 2> texts{&result.out, &result.err};
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    if (stop) return ChildResult::End::stopped;
    if (Clock::now() > end) return ChildResult::End::too_long;
    if (poll(streams.data(), streams.size(), look_up_ms) <= 0) continue;
    for (std::size_t i = 0; i < streams.size(); ++i) {
      if (streams[i].fd < 0 || streams[i].revents == 0) continue;
      if (!take(streams[i].fd, *texts[i])) streams[i].fd = -1;
      if (texts[i]->size() > options.output) return ChildResult::End::too_long;
    }
  }
  return ChildResult::End::exited;
}

}  // namespace

ChildResult run_child(const ChildOptions& options, const std::atomic<bool>& stop) {
  Pipe out;
  Pipe err;
  const pid_t child = start(options, out, err);
  out.close_end(1);
  err.close_end(1);
  ChildResult result;
  result.end = read_all(options, stop, out, err, result);
  if (result.end != ChildResult::End::exited) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (result.end != ChildResult::End::exited) return result;
  if (WIFSIGNALED(status)) {
    result.end = ChildResult::End::killed;
    result.code = WTERMSIG(status);
  } else {
    result.code = WEXITSTATUS(status);
  }
  return result;
}

}  // namespace stagger::server
