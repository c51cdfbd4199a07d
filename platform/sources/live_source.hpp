// Base class of live sources: slots filled by a reading thread and emptied by the tracker, and the
// map from the stamps' clock to session time.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "platform/formats/camera.hpp"
#include "platform/formats/frame_buffer.hpp"
#include "platform/runtime/rt/clock_map.hpp"
#include "platform/runtime/rt/release.hpp"
#include "platform/runtime/session/frame_source.hpp"

namespace glint {

// Capacity of frames: those that wait for the tracker, and the one that it has.
inline constexpr std::size_t k_live_frames = 8;
// Period of checks for the end of a run.
inline constexpr Duration k_live_poll = milliseconds(50);
// Largest magnitude of a stamp: the difference of two fits into 64 bits.
inline constexpr std::int64_t k_live_stamp_max_ns = 4'000'000'000'000'000'000;

// Decoder of hl2ss's long throw frames (hl2ss_long_throw.hpp).
using LongThrowPlanes = std::vector<std::uint8_t> (*)(std::span<const std::uint8_t> png,
                                                      const Camera& camera,
                                                      const std::string& name);

struct LiveSettings {
  Duration duration;                            // of the run; 0: until it is stopped
  const std::atomic<bool>* stop = nullptr;      // true: ends the run
  std::int64_t frames = 0;                      // ends the run after this number; 0: no limit
  LongThrowPlanes long_throw_planes = nullptr;  // null: a program without PNG refuses long throw
};

class LiveSource : public FrameSource {
 public:
  LiveSource(const Camera& camera, LiveSettings settings);

  // Throws InputError if the clock is not live.
  void start(const SourceClock& clock) override;
  [[nodiscard]] bool wait(ArrivedFrame& arrived) override;
  void release_pixels(const ArrivedFrame& arrived) noexcept override {
    used_[static_cast<std::size_t>(arrived.slot)] = false;
  }
  [[nodiscard]] Duration duration() const noexcept override { return settings_.duration; }
  [[nodiscard]] double delivered_part() const noexcept override;
  [[nodiscard]] SourceFaults* faults() noexcept override { return &faults_; }

  // The rest is for the reading thread, and for report() after its end.

  // Pixels of a frame, of the camera's size.
  struct Slot {
    FrameBuffer pixels;
    Time mid_exposure, arrival;
    Duration stamp_sigma;
    HeadPose head;
  };
  [[nodiscard]] const Camera& camera() const { return camera_; }
  // Call when a producer connects: its clock may differ.
  void restart_clock();
  // If the stamp is newer than `newest`, stores it there and returns true; otherwise counts it. A
  // stamp far before `newest` may be of a clock that was set back: it is accepted here and the
  // clock map decides.
  [[nodiscard]] bool accept_rising(Time stamp, Time& newest);
  // Returns the mid-exposure in session time; empty if the stamp is refused (counted) or before the
  // session.
  [[nodiscard]] std::optional<Time> exposure_of(Time stamp, Time arrival);
  // Returns the slot for the next frame. If all are used, the oldest frame that waits is dropped
  // and counted, since a pose needs the newest one. Null if the tracker has all of them.
  [[nodiscard]] Slot* slot_for_next();
  // Publishes the slot of slot_for_next(). arrival: monotonic clock. An invalid head pose is
  // cleared and counted.
  void publish(Time mid_exposure, Time arrival, const HeadPose& head);
  [[nodiscard]] std::uint64_t published() const { return written_; }
  // Reports a fault at once; the caller counts it.
  void note(SourceFault fault) noexcept;
  // Adds the counts, the failures and the faults of this class to the report.
  void add_to(SourceReport& report) const;

 private:
  [[nodiscard]] bool is_over(Time now) const noexcept;
  // Removes the oldest frame that waits and returns its slot. Called by the tracker and, to drop
  // the frame, by the reading thread.
  [[nodiscard]] std::optional<std::size_t> take_oldest() noexcept;
  [[nodiscard]] std::optional<std::size_t> unused_slot() const noexcept;
  [[nodiscard]] Time session_time(Time monotonic) const {
    return Time{} + (monotonic - clock_.epoch);
  }

  Camera camera_;
  LiveSettings settings_;
  SourceClock clock_;
  SourceFaults faults_;
  std::vector<Slot> slots_;
  Release is_read_;
  // The frames numbered [taken_, written_) wait; frame n is in slot order_[n % k_live_frames].
  std::atomic<std::uint64_t> written_{0}, taken_{0};
  std::array<std::atomic<std::size_t>, k_live_frames> order_{};
  std::array<std::atomic<bool>, k_live_frames> used_{};  // by frames that wait, or by the tracker
  std::size_t next_slot_ = 0;                            // of slot_for_next()
  std::uint64_t delivered_ = 0;
  std::atomic<bool> started_{false}, ended_{false};
  std::optional<ClockMap> map_;
  Time newest_exposure_;
  std::uint64_t dropped_ = 0, backward_ = 0, clock_refused_ = 0, clock_restarts_ = 0,
                without_pose_ = 0, poses_refused_ = 0;
};

}  // namespace glint
