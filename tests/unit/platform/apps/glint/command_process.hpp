// A glint command in a process of its own, with its output in a file.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/unit/beside_test.hpp"
#include "tests/unit/text_of.hpp"

namespace glint {

class CommandProcess {
 public:
  // Starts glint with these arguments; both output streams are written to `log`.
  CommandProcess(std::vector<std::string> arguments, std::string log) : log_(std::move(log)) {
    arguments.insert(arguments.begin(), path_beside_test("glint"));
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    posix_spawn_file_actions_t outputs;
    posix_spawn_file_actions_init(&outputs);
    posix_spawn_file_actions_addopen(&outputs, 1, log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&outputs, 1, 2);
    EXPECT_EQ(posix_spawn(&process_, words[0], &outputs, nullptr, words.data(), environ), 0);
    posix_spawn_file_actions_destroy(&outputs);
  }
  ~CommandProcess() {
    if (process_ < 0 || has_ended()) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  CommandProcess(const CommandProcess&) = delete;
  CommandProcess& operator=(const CommandProcess&) = delete;

  // Calls `act` repeatedly until `done` holds or the process ends. Returns false after k_timeout.
  template <class Act, class Done>
  [[nodiscard]] bool repeat_until(Act act, Done done) {
    const auto end = std::chrono::steady_clock::now() + k_timeout;
    while (!has_ended() && !done()) {
      if (std::chrono::steady_clock::now() > end) return false;
      act();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
  }
  // Returns the exit code; -1 if the process does not end within k_timeout or ends by a signal.
  template <class Act>
  [[nodiscard]] int exit_code(Act act) {
    const bool ended = repeat_until(act, [] { return false; });
    return ended && WIFEXITED(*status_) ? WEXITSTATUS(*status_) : -1;
  }
  [[nodiscard]] int exit_code() {
    return exit_code([] {});
  }
  [[nodiscard]] bool has_ended() {
    int status = 0;
    if (!status_ && waitpid(process_, &status, WNOHANG) == process_) status_ = status;
    return status_.has_value();
  }
  // Sends SIGINT, as Ctrl-C does.
  void interrupt() {
    if (!has_ended()) kill(process_, SIGINT);
  }
  [[nodiscard]] std::string words() const { return text_of(log_); }

 private:
  // Long enough for a sanitizer build on a busy machine.
  static constexpr std::chrono::seconds k_timeout{240};

  std::string log_;
  pid_t process_ = -1;
  std::optional<int> status_;
};

}  // namespace glint
