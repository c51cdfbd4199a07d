#include "platform/sinks/dds/reader_process.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <thread>
#include <vector>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr Duration k_end_limit = milliseconds(5000);  // from SIGTERM to the end of the process

std::string reader_program() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  return (self.parent_path() / "glint_dds_reader").string();
}

std::vector<std::string> arguments_of(const DdsSettings& settings, const std::string& file) {
  std::vector<std::string> arguments = {reader_program(),
                                        "--interface",
                                        settings.interface,
                                        "--domain",
                                        std::to_string(settings.domain),
                                        "--prefix",
                                        settings.topic_prefix,
                                        "--out",
                                        file};
  for (const std::string& tool : settings.tool_names) {
    arguments.insert(arguments.end(), {"--tool", tool});
  }
  for (const std::string& peer : settings.peers) {
    arguments.insert(arguments.end(), {"--peer", peer});
  }
  return arguments;
}

// Attributes of the child process. SIGTERM is blocked until the child handles it. The child has a
// process group of its own, so that Ctrl-C does not end it before the sink's last message.
class SpawnAttributes {
 public:
  SpawnAttributes() {
    posix_spawnattr_init(&attributes_);
    sigset_t blocked;
    sigemptyset(&blocked);
    sigaddset(&blocked, SIGTERM);
    posix_spawnattr_setsigmask(&attributes_, &blocked);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnAttributes() { posix_spawnattr_destroy(&attributes_); }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;
  [[nodiscard]] const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_;
};

}  // namespace

ReaderProcess::ReaderProcess(const DdsSettings& settings, const std::string& result_file)
    : result_file_(result_file) {
  std::remove(result_file.c_str());  // removes the result of an earlier run
  std::vector<std::string> arguments = arguments_of(settings, result_file);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const SpawnAttributes attributes;
  const int code =
      posix_spawn(&id_, pointers[0], nullptr, attributes.get(), pointers.data(), environ);
  if (code != 0) {
    id_ = -1;
    throw MissingDevice("dds: cannot start " + arguments[0] + ": " + std::strerror(code) +
                        "; expected glint_dds_reader beside this program");
  }
}

ReaderProcess::~ReaderProcess() {
  if (id_ < 0) return;
  kill(id_, SIGTERM);
  if (!wait(k_end_limit)) {
    kill(id_, SIGKILL);
    waitpid(id_, nullptr, 0);
  }
}

ReaderResult ReaderProcess::finish(Duration limit) {
  if (!wait(limit)) {
    kill(id_, SIGTERM);
    if (!wait(k_end_limit)) throw MissingDevice("dds: the reader process does not end");
  }
  if (!WIFEXITED(status_) || WEXITSTATUS(status_) != 0) {
    const std::string how = WIFSIGNALED(status_)
                                ? "was ended by signal " + std::to_string(WTERMSIG(status_))
                                : "ended with code " + std::to_string(WEXITSTATUS(status_));
    throw MissingDevice("dds: the reader process " + how + "; expected its result in " +
                        result_file_);
  }
  return load_result(result_file_);
}

bool ReaderProcess::wait(Duration limit) {
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

}  // namespace glint
