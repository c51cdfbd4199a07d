// Interface of a frame source. A run waits for each frame and returns its pixels after use. The
// same source serves live runs and runs in order.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kernels/image/frame.hpp"
#include "kernels/pose/head_pose.hpp"
#include "platform/formats/frame_truth.hpp"
#include "platform/runtime/rt/source_faults.hpp"

namespace glint {

struct MarkerFrame;

struct ArrivedFrame {
  Frame frame;  // pixels are valid until release_pixels()
  HeadPose head;
  int slot = -1;                         // the source's index of the pixel buffer
  const MarkerFrame* markers = nullptr;  // of a recording without pixels: its detected markers
};

// The session's clock.
struct SourceClock {
  bool live = false;          // false: frames are requested in order, without waiting
  Time epoch;                 // monotonic clock at session time zero
  std::function<Time()> now;  // session time; thread-safe
};

// Frame losses of a source, for the table, the JSON and the exit code.
struct SourceReport {
  std::string text;  // "recording out/run.mcap, level full"; empty: nothing to report
  std::vector<std::pair<std::string, std::uint64_t>> counts;  // by name, including zeros
  std::vector<std::string> failures;                          // one line per loss
  // The first faults of each kind, in the order of time.
  struct Event {
    std::string_view fault;
    Time time;
    std::uint64_t frames = 0;  // published before it
  };
  std::vector<Event> events{};
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;

  // Does work that should precede the start of the session's clock. `go_on(ready, wanted)`, in
  // frames, returns false to end it early.
  virtual void prepare(const std::function<bool(int, int)>& /*go_on*/) {}
  // Call once, before the first wait().
  virtual void start(const SourceClock& clock) = 0;
  // Blocks until a frame has arrived; returns false if there are no more. The only blocking call of
  // the frame group.
  [[nodiscard]] virtual bool wait(ArrivedFrame& arrived) = 0;
  virtual void release_pixels(const ArrivedFrame& arrived) noexcept = 0;

  // Counter of a living frame thread: raised after each frame, and by wait() of a source whose
  // frames may stay away at each of its wake-ups.
  [[nodiscard]] const std::atomic<std::uint64_t>& advances() const noexcept { return advances_; }
  void note_advance() noexcept { advances_.fetch_add(1, std::memory_order_relaxed); }

  // late(): whether the newest frame due at this time arrived late or has not arrived yet.
  // late_frames(): number of late frames. Both thread-safe.
  [[nodiscard]] virtual bool late(Time /*now*/) const noexcept { return false; }
  [[nodiscard]] virtual int late_frames() const noexcept { return 0; }

  // Faults as they happen; null: not live.
  [[nodiscard]] virtual SourceFaults* faults() noexcept { return nullptr; }

  // Number of frames and their duration; 0: unknown in advance.
  [[nodiscard]] virtual std::size_t frame_count() const noexcept { return 0; }
  [[nodiscard]] virtual Duration duration() const noexcept { return {}; }
  // Delivered fraction of frame_count(). Thread-safe.
  [[nodiscard]] virtual double delivered_part() const noexcept { return 0; }
  // Ground truth of each delivered frame, in the order of delivery; complete once wait() has
  // returned false. Empty: the source has no ground truth.
  [[nodiscard]] virtual const std::vector<FrameGroundTruth>& ground_truths() const noexcept {
    static const std::vector<FrameGroundTruth> none;
    return none;
  }
  // True T_world_tool of the cell's tool; nullopt: no ground truth at that time. Thread-safe.
  [[nodiscard]] virtual std::optional<Pose> ground_truth_of_tool(int /*tool*/,
                                                                 Time /*time*/) const {
    return std::nullopt;
  }
  // Offset from session time to Unix time, if the frames' time stamps define it; for a run in
  // order.
  [[nodiscard]] virtual std::optional<Duration> unix_offset() const noexcept {
    return std::nullopt;
  }
  // Call after the last wait().
  [[nodiscard]] virtual SourceReport report() { return {}; }

 private:
  std::atomic<std::uint64_t> advances_{0};
};

}  // namespace glint
