// Receiver of button frames over CAN, in a thread of its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "kernels/units.hpp"
#include "platform/descriptor.hpp"
#include "platform/sinks/can/button_frames.hpp"

namespace glint {

// Arrival time of a message on the companion computer's clock: `local_now` minus the age of the
// kernel's time stamp at `unix_now`, both read together. If the age is not between 0 and 10 s, the
// Unix clock was set in between, and the result is `local_now`.
[[nodiscard]] Time monotonic_arrival(Time unix_stamp, Time unix_now, Time local_now) noexcept;

class CanButtons {
 public:
  // `socket` returns one frame per read, as a CAN socket does. Events carry the companion
  // computer's time: of reception by the kernel if the frame has a time stamp, else of the read.
  // The Unix clock is read only here: a later step of it shifts no event. `on_button` is called
  // from the reading thread, also for the release of a button whose sender was silent for
  // `timeout`.
  CanButtons(Descriptor socket, std::uint32_t identifier, Duration unix_minus_local,
             ButtonFrames::OnButton on_button, Duration timeout = k_button_timeout);
  ~CanButtons();  // stop()
  CanButtons(const CanButtons&) = delete;
  CanButtons& operator=(const CanButtons&) = delete;

  void start();
  void stop();
  // Without a thread: waits for a frame, at most `limit`, and reads the pending frames, at most
  // 256. Returns their number.
  int read(Duration limit);

  // From any thread.
  [[nodiscard]] ButtonFrameCounts counts() const noexcept { return frames_.counts(); }

 private:
  bool read_one();
  [[nodiscard]] Time local_now() const;

  Descriptor socket_;
  Duration local_minus_monotonic_;
  ButtonFrames frames_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

// Opens and starts "socketcan:IF"; null for a log, which is write-only. Throws as open_can_sink.
[[nodiscard]] std::unique_ptr<CanButtons> open_can_buttons(const std::string& specification,
                                                           std::uint32_t identifier,
                                                           Duration unix_minus_local,
                                                           ButtonFrames::OnButton on_button,
                                                           Duration timeout = k_button_timeout);

}  // namespace glint
