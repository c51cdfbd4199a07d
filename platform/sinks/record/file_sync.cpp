#include "platform/sinks/record/file_sync.hpp"

#include <pthread.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <stop_token>

namespace glint {

FileSync::FileSync(int descriptor, Duration period)
    : thread_([this, descriptor, period](const std::stop_token& stop) {
        std::unique_lock lock(mutex_);
        const std::chrono::nanoseconds gap(period.nanoseconds);
        while (!ends_.wait_for(lock, stop, gap, [&] { return stop.stop_requested(); })) {
          if (::fdatasync(descriptor) == 0) continue;
          int none = 0;
          error_.compare_exchange_strong(none, errno);
        }
      }) {
  pthread_setname_np(thread_.native_handle(), "glint_sync");
}

void FileSync::stop() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

}  // namespace glint
