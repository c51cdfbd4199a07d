// Where frames come from: a run waits for the next one, and gives its pixels back when it is done
// with them. The same source serves a live run and one in order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kernels/image/frame.hpp"
#include "kernels/pose/head_pose.hpp"
#include "platform/sensors/frame_truth.hpp"

namespace glint {

struct MarkerFrame;

struct ArrivedFrame {
  Frame frame;  // its pixels stay valid until give_back()
  HeadPose head;
  int slot = -1;                         // the source's own number for the pixels' place
  const MarkerFrame* markers = nullptr;  // of a recording without pixels: what was found in them
};

// The session's clock.
struct SourceClock {
  bool live = false;          // false: frames are asked for in order, as fast as they come
  Time epoch;                 // monotonic: where the session's time begins
  std::function<Time()> now;  // of the session; any thread
};

// What became of the frames that a source had, for the table, the JSON and the exit code.
struct SourceReport {
  std::string text;  // "recording out/run.mcap, level full"; empty: nothing to report
  std::vector<std::pair<std::string, std::uint64_t>> counts;  // by name, zeros among them
  std::vector<std::string> failures;                          // what was lost, a line each
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;

  // Does what is better done before the session's clock starts. `go_on(ready, wanted)`, frames,
  // ends it early with false.
  virtual void prepare(const std::function<bool(int, int)>& /*go_on*/) {}
  // Once, before the first wait().
  virtual void start(const SourceClock& clock) = 0;
  // Blocks until a frame has arrived; false: there are no more. The only blocking call of the
  // frame group.
  [[nodiscard]] virtual bool wait(ArrivedFrame& arrived) = 0;
  virtual void give_back(const ArrivedFrame& arrived) noexcept = 0;

  // Whether the newest frame that is due at this time came late, or has not come yet; how many came
  // late. From any thread.
  [[nodiscard]] virtual bool late(Time /*now*/) const noexcept { return false; }
  [[nodiscard]] virtual int late_frames() const noexcept { return 0; }

  // Frames in all and their duration; 0: not known before they arrive.
  [[nodiscard]] virtual std::size_t frame_count() const noexcept { return 0; }
  [[nodiscard]] virtual Duration duration() const noexcept { return {}; }
  // Delivered part of frame_count(). From any thread.
  [[nodiscard]] virtual double delivered_part() const noexcept { return 0; }
  // One for each frame delivered, in the order of delivery, complete once wait() returned false;
  // empty: it has no truth.
  [[nodiscard]] virtual const std::vector<FrameTruth>& truths() const noexcept {
    static const std::vector<FrameTruth> none;
    return none;
  }
  // T_world_tool of the cell's tool; nothing: no truth at that time. From any thread.
  [[nodiscard]] virtual std::optional<Pose> truth_of_tool(int /*tool*/, Time /*time*/) const {
    return std::nullopt;
  }
  // Added to the session's time it gives Unix time, where the frames' stamps do; for a run in
  // order.
  [[nodiscard]] virtual std::optional<Duration> unix_offset() const noexcept {
    return std::nullopt;
  }
  // After the last wait().
  [[nodiscard]] virtual SourceReport report() { return {}; }
};

}  // namespace glint
