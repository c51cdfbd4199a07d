// Periodic fdatasync of a growing file in a thread of its own. A power failure loses only the data
// since the last call.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "kernels/units.hpp"

namespace glint {

class FileSync {
 public:
  // The descriptor must stay open until stop() has returned.
  FileSync(int descriptor, Duration period);
  ~FileSync() { stop(); }
  FileSync(const FileSync&) = delete;
  FileSync& operator=(const FileSync&) = delete;

  void stop();
  // The first failure's errno; 0: none. From any thread.
  [[nodiscard]] int error() const noexcept { return error_; }

 private:
  std::atomic<int> error_{0};
  std::mutex mutex_;
  std::condition_variable_any ends_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace glint
