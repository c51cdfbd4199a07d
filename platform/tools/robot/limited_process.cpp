#include "platform/tools/robot/limited_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "platform/input_error.hpp"

namespace glint {
namespace {

using Clock = std::chrono::steady_clock;

// Standard streams of the child: the pipe's write end is its standard output and open nowhere else.
class Files {
 public:
  explicit Files(int output) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  }
  ~Files() { posix_spawn_file_actions_destroy(&actions_); }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

enum class ReadResult : std::uint8_t { some, all, no_more_time };

// Reads from the pipe; waits for data until the deadline.
ReadResult read_some(int pipe, Clock::time_point deadline, std::string& bytes) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
  if (left.count() <= 0) return ReadResult::no_more_time;
  pollfd ready{pipe, POLLIN, 0};
  if (::poll(&ready, 1, static_cast<int>(std::min<long long>(left.count(), 1000))) <= 0) {
    return ReadResult::some;  // the caller tests the deadline again
  }
  std::array<char, 65536> piece{};
  const ssize_t size = ::read(pipe, piece.data(), piece.size());
  if (size < 0) return errno == EINTR ? ReadResult::some : ReadResult::all;
  bytes.append(piece.data(), static_cast<std::size_t>(size));
  return size == 0 ? ReadResult::all : ReadResult::some;
}

// Waits for the exit and kills at the deadline: a program may close its output and continue.
ProcessEnd end_of(pid_t process, Clock::time_point deadline) {
  int status = 0;
  while (::waitpid(process, &status, WNOHANG) == 0) {
    if (Clock::now() >= deadline) {
      ::kill(process, SIGKILL);
      ::waitpid(process, &status, 0);
      return ProcessEnd::timed_out;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (!WIFEXITED(status)) return ProcessEnd::killed;
  return WEXITSTATUS(status) == 0 ? ProcessEnd::done : ProcessEnd::failed;
}

}  // namespace

ProcessOutput output_of(std::vector<std::string> command, const ProcessLimits& limits) {
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::array<int, 2> ends{};  // read, write
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw MissingDevice(command[0] + ": no pipe: " + std::strerror(errno));
  }
  pid_t process = -1;
  const Files files(ends[1]);
  const int failed =
      ::posix_spawn(&process, arguments[0], files.get(), nullptr, arguments.data(), environ);
  ::close(ends[1]);
  if (failed != 0) {
    ::close(ends[0]);
    throw MissingDevice(command[0] + ": cannot be started: " + std::strerror(failed) +
                        "; expected the program beside this one");
  }
  const auto deadline = Clock::now() + std::chrono::nanoseconds(limits.time.nanoseconds);
  ProcessOutput out;
  ReadResult result = ReadResult::some;
  while (result == ReadResult::some && out.bytes.size() <= limits.output_bytes) {
    result = read_some(ends[0], deadline, out.bytes);
  }
  ::close(ends[0]);
  if (result == ReadResult::some) ::kill(process, SIGKILL);
  out.end = end_of(process, deadline);
  if (result == ReadResult::some) out.end = ProcessEnd::too_much;
  return out;
}

}  // namespace glint
