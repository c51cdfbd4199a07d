#include "platform/sinks/dds/child_process.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <thread>

#include "platform/input_error.hpp"

namespace glint {
namespace {

std::string beside_this_program(const std::string& name) {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  return (self.parent_path() / name).string();
}

class SpawnOptions {
 public:
  SpawnOptions(int descriptor, int as_descriptor) {
    posix_spawnattr_init(&attributes_);
    sigset_t blocked;
    sigemptyset(&blocked);
    sigaddset(&blocked, SIGTERM);
    posix_spawnattr_setsigmask(&attributes_, &blocked);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
    posix_spawn_file_actions_init(&actions_);
    if (descriptor >= 0) posix_spawn_file_actions_adddup2(&actions_, descriptor, as_descriptor);
  }
  ~SpawnOptions() {
    posix_spawnattr_destroy(&attributes_);
    posix_spawn_file_actions_destroy(&actions_);
  }
  SpawnOptions(const SpawnOptions&) = delete;
  SpawnOptions& operator=(const SpawnOptions&) = delete;
  [[nodiscard]] const posix_spawnattr_t* attributes() const { return &attributes_; }
  [[nodiscard]] const posix_spawn_file_actions_t* actions() const { return &actions_; }

 private:
  posix_spawnattr_t attributes_;
  posix_spawn_file_actions_t actions_;
};

}  // namespace

ChildProcess::ChildProcess(std::vector<std::string> arguments, int descriptor, int as_descriptor) {
  const std::string name = arguments.front();
  arguments.front() = beside_this_program(name);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const SpawnOptions options(descriptor, as_descriptor);
  const int code = posix_spawn(&id_, pointers[0], options.actions(), options.attributes(),
                               pointers.data(), environ);
  if (code == 0) return;
  id_ = -1;
  throw MissingDevice("dds: cannot start " + arguments.front() + ": " + std::strerror(code) +
                      "; expected " + name + " beside this program");
}

ChildProcess::~ChildProcess() { kill(); }

bool ChildProcess::wait(Duration limit) {
  const auto deadline =
      std::chrono::steady_clock::now() + std::chrono::nanoseconds(limit.nanoseconds);
  while (id_ >= 0) {
    if (waitpid(id_, &status_, WNOHANG) == id_) {
      id_ = -1;
    } else if (std::chrono::steady_clock::now() >= deadline) {
      return false;
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  return true;
}

void ChildProcess::send(int signal) const {
  if (id_ >= 0) ::kill(id_, signal);
}

void ChildProcess::kill() {
  send(SIGKILL);
  if (id_ >= 0) waitpid(id_, &status_, 0);
  id_ = -1;
}

bool ChildProcess::succeeded() const { return WIFEXITED(status_) && WEXITSTATUS(status_) == 0; }

std::string ChildProcess::how_it_ended() const {
  return WIFSIGNALED(status_) ? "was ended by signal " + std::to_string(WTERMSIG(status_))
                              : "ended with code " + std::to_string(WEXITSTATUS(status_));
}

}  // namespace glint
