// Live source of frames from another process through shared memory. A Unix socket passes the memory
// and each frame's slot number (glint_frames.h, for producers). A thread copies the frame and
// publishes it.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>

#include "platform/sources/glint_frames.h"
#include "platform/sources/live_source.hpp"

namespace glint {

class ShmSource final : public LiveSource {
 public:
  // Listens at `path`. Throws InputError if the socket cannot be created or another process has it.
  ShmSource(const std::string& path, const Camera& camera, LiveSettings settings);
  ~ShmSource() override;
  ShmSource(const ShmSource&) = delete;
  ShmSource& operator=(const ShmSource&) = delete;

  [[nodiscard]] SourceReport report() override;

 private:
  // A connected producer.
  struct Producer;

  void run() noexcept;
  void accept_producer(std::optional<Producer>& producer);
  void refuse_producer(const std::string& why, int socket);
  void read_message(std::optional<Producer>& producer);
  void take_frame(Producer& producer, const void* message);
  void copy_frame(Producer& producer, const glint_frames_frame& frame, Time arrival);
  [[nodiscard]] bool copy_pixels(const Producer& producer, std::uint32_t slot, Slot& to) const;
  void stop();

  std::string path_;
  int listener_ = -1;
  std::atomic<bool> stop_{false};
  // Accessed by the reading thread, and by report() after its end.
  Time newest_stamp_;
  std::uint64_t connected_ = 0, refused_ = 0, torn_ = 0, skipped_ = 0, malformed_ = 0;
  std::string first_refusal_;
  std::thread thread_;
};

}  // namespace glint
