// Live frames of another process through shared memory: a Unix socket passes the memory and, for
// each frame, the number of its slot (glint_frames.h, for producers). A thread copies the frame,
// maps its stamp to this machine's clock and hands it over.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "platform/rt/clock_map.hpp"
#include "platform/rt/release.hpp"
#include "platform/sensors/camera.hpp"
#include "platform/sensors/frame_buffer.hpp"
#include "platform/session/frame_source.hpp"

namespace glint {

struct LiveSettings {
  Duration duration;                        // of the run; 0: until it is stopped
  const std::atomic<bool>* stop = nullptr;  // set: the run ends
};

class ShmSource final : public FrameSource {
 public:
  // Listens at `path`. Throws InputError: no socket can be made there, or another process has it.
  ShmSource(const std::string& path, const Camera& camera, LiveSettings settings);
  ~ShmSource() override;
  ShmSource(const ShmSource&) = delete;
  ShmSource& operator=(const ShmSource&) = delete;

  // A live clock.
  void start(const SourceClock& clock) override;
  [[nodiscard]] bool wait(ArrivedFrame& arrived) override;
  void give_back(const ArrivedFrame& arrived) noexcept override;
  [[nodiscard]] Duration duration() const noexcept override { return settings_.duration; }
  [[nodiscard]] double delivered_part() const noexcept override;
  [[nodiscard]] SourceReport report() override;

 private:
  struct Slot {
    FrameBuffer pixels;
    Time mid_exposure, arrival;
    HeadPose head;
  };
  // A producer that is connected.
  struct Producer;

  void run() noexcept;
  void accept_producer(std::optional<Producer>& producer);
  void read_message(std::optional<Producer>& producer);
  void take_frame(Producer& producer, const void* message);
  [[nodiscard]] bool copy_pixels(const Producer& producer, std::uint32_t slot, Slot& to) const;
  [[nodiscard]] Time session_time(Time monotonic) const {
    return Time{} + (monotonic - clock_.epoch);
  }
  void stop();

  std::string path_;
  Camera camera_;
  LiveSettings settings_;
  SourceClock clock_;
  int listener_ = -1;
  std::vector<Slot> slots_;
  Release is_read_;
  std::atomic<std::uint64_t> written_{0}, given_back_{0};
  std::uint64_t delivered_ = 0;
  std::atomic<bool> started_{false}, stop_{false};
  // Of the reading thread, and of report() after the end.
  std::optional<ClockMap> map_;
  Time newest_stamp_, newest_exposure_;
  std::uint64_t connected_ = 0, refused_ = 0, torn_ = 0, dropped_ = 0, skipped_ = 0, backward_ = 0,
                clock_refused_ = 0, clock_restarts_ = 0, without_pose_ = 0, poses_refused_ = 0,
                malformed_ = 0;
  std::string first_refusal_;
  std::thread thread_;
};

}  // namespace glint
