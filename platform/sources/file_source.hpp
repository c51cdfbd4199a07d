// Source of recorded frames: a thread reads ahead into slots and orders the time stamps; wait()
// returns each frame at its time (live) or at once (in order).
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "platform/formats/camera.hpp"
#include "platform/runtime/rt/release.hpp"
#include "platform/runtime/session/frame_source.hpp"
#include "platform/sources/frame_reader.hpp"
#include "platform/sources/stamp_gate.hpp"

namespace glint {

class FileSource final : public FrameSource {
 public:
  // Starts reading. duration: drops frames that arrive later in the session; 0: drops none. Throws
  // InputError if the first frame cannot be read, does not have the size and bits of `camera`, or
  // has no depth.
  FileSource(std::unique_ptr<FrameReader> reader, const Camera& camera, Duration duration = {});
  ~FileSource() override;
  FileSource(const FileSource&) = delete;
  FileSource& operator=(const FileSource&) = delete;

  void start(const SourceClock& clock) override { clock_ = clock; }
  [[nodiscard]] bool wait(ArrivedFrame& arrived) override;
  void release_pixels(const ArrivedFrame& /*arrived*/) noexcept override { is_free_.post(); }
  [[nodiscard]] bool late(Time now) const noexcept override {
    return now.nanoseconds >= late_since_ns_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] int late_frames() const noexcept override { return late_frames_; }
  [[nodiscard]] std::optional<Duration> unix_offset() const noexcept override;
  // Stops reading.
  [[nodiscard]] SourceReport report() override;

 private:
  struct Slot {
    ReadFrame frame;
    Time arrival;
    std::uint64_t sequence = 0;
    bool end = false;  // no frame: end of the file
  };

  void read_all() noexcept;
  void stop();
  [[nodiscard]] bool read_usable(Slot& slot);
  [[nodiscard]] std::string camera_mismatch(const FrameBuffer& pixels) const;
  void convert_to_session_time(Slot& slot);
  [[nodiscard]] Slot& slot_of(std::size_t number) { return slots_[number % slots_.size()]; }

  std::unique_ptr<FrameReader> reader_;
  Camera camera_;
  Duration duration_;
  SourceClock clock_;
  std::vector<Slot> slots_;
  Release is_free_, is_read_;  // once per slot
  std::size_t delivered_ = 0;
  std::atomic<std::size_t> read_{0};
  std::atomic<bool> stop_{false};
  std::atomic<int> late_frames_{0};
  std::atomic<std::int64_t> late_since_ns_{INT64_MAX};
  Time newest_delivered_;  // its arrival
  // Accessed by the reading thread, and by report() after its end.
  StampGate gate_;
  Duration origin_;  // of session time, on the stamps' clock
  Time newest_arrival_;
  std::uint64_t next_sequence_ = 0, without_pose_ = 0, poses_refused_ = 0, camera_mismatches_ = 0;
  std::string first_camera_mismatch_, ended_by_;
  std::thread thread_;
};

}  // namespace glint
