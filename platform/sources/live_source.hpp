// What all live sources have in common: slots that a reading thread fills and the tracker empties,
// and the map from the stamps' clock to the session's.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "platform/rt/clock_map.hpp"
#include "platform/rt/release.hpp"
#include "platform/sensors/camera.hpp"
#include "platform/sensors/frame_buffer.hpp"
#include "platform/session/frame_source.hpp"

namespace glint {

inline constexpr std::size_t k_live_frames = 8;  // that wait for the tracker
// Until the end of a run is noticed.
inline constexpr Duration k_live_poll = milliseconds(50);

struct LiveSettings {
  Duration duration;                        // of the run; 0: until it is stopped
  const std::atomic<bool>* stop = nullptr;  // set: the run ends
  std::int64_t frames = 0;                  // the run ends after so many; 0: it does not
};

class LiveSource : public FrameSource {
 public:
  LiveSource(const Camera& camera, LiveSettings settings);

  // Throws InputError: no live clock.
  void start(const SourceClock& clock) override;
  [[nodiscard]] bool wait(ArrivedFrame& arrived) override;
  void give_back(const ArrivedFrame& /*arrived*/) noexcept override { ++given_back_; }
  [[nodiscard]] Duration duration() const noexcept override { return settings_.duration; }
  [[nodiscard]] double delivered_part() const noexcept override;

  // All that follows is of the reading thread, and of report() after its end.

  // The pixels of a frame, of the camera's size.
  struct Slot {
    FrameBuffer pixels;
    Time mid_exposure, arrival;
    Duration stamp_sigma;
    HeadPose head;
  };
  [[nodiscard]] const Camera& camera() const { return camera_; }
  // Another producer may have another clock.
  void restart_clock();
  // Whether a stamp comes after `newest`, which it then is; counted where not. One that lies far
  // before it may be of a clock that was set: the map decides.
  [[nodiscard]] bool ascends(Time stamp, Time& newest);
  // A frame's mid-exposure by the session's clock; nothing: the stamp is refused and counted, or
  // lies before the session.
  [[nodiscard]] std::optional<Time> exposure_of(Time stamp, Time arrival);
  // For the next frame; null: all are with the tracker, and drop() counts the frame.
  [[nodiscard]] Slot* room();
  void drop() { dropped_ += ended_ ? 0 : 1; }
  // Hands over the slot of room(). `arrival`: monotonic. A head pose that no headset has is cleared
  // and counted.
  void publish(Time mid_exposure, Time arrival, const HeadPose& head);
  [[nodiscard]] std::uint64_t published() const { return written_; }
  // What was counted here, and what was lost.
  void add_to(SourceReport& report) const;

 private:
  [[nodiscard]] bool is_over(Time now) const noexcept;
  [[nodiscard]] Time session_time(Time monotonic) const {
    return Time{} + (monotonic - clock_.epoch);
  }

  Camera camera_;
  LiveSettings settings_;
  SourceClock clock_;
  std::vector<Slot> slots_;
  Release is_read_;
  std::atomic<std::uint64_t> written_{0}, given_back_{0};
  std::uint64_t delivered_ = 0;
  std::atomic<bool> started_{false}, ended_{false};
  std::optional<ClockMap> map_;
  Time newest_exposure_;
  std::uint64_t dropped_ = 0, backward_ = 0, clock_refused_ = 0, clock_restarts_ = 0,
                without_pose_ = 0, poses_refused_ = 0;
};

}  // namespace glint
