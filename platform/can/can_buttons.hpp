// Buttons that come over CAN, read by a thread of their own beside the run.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "kernels/units.hpp"
#include "platform/can/button_frames.hpp"
#include "platform/can/descriptor.hpp"

namespace glint {

// When a message arrived, on the board's clock: the kernel's stamp lies before `unix_now` by as
// much as the arrival lies before `board_now`, both read together. If that is not between 0 and
// 10 s, the Unix clock was set meanwhile and the arrival is now.
[[nodiscard]] Time board_arrival(Time unix_stamp, Time unix_now, Time board_now) noexcept;

class CanButtons {
 public:
  // `socket` gives one frame a read, as a CAN socket does. Events are in the board's time:
  // when the kernel received the frame, by its stamp, else when it was read. The Unix clock is
  // read once, here: a later step of it moves no event. `on_button` is called from the reading
  // thread, also with the release of a button whose sender has been silent for `timeout`.
  CanButtons(Descriptor socket, std::uint32_t identifier, Duration unix_minus_board,
             ButtonFrames::OnButton on_button, Duration timeout = k_button_timeout);
  ~CanButtons();  // stop()
  CanButtons(const CanButtons&) = delete;
  CanButtons& operator=(const CanButtons&) = delete;

  void start();
  void stop();
  // Without a thread: waits for a frame, at most `limit`, and takes what is there, but never more
  // than 256. Gives how many it took.
  int read(Duration limit);

  // From any thread.
  [[nodiscard]] ButtonFrameCounts counts() const noexcept { return frames_.counts(); }

 private:
  bool take();
  [[nodiscard]] Time board_now() const;

  Descriptor socket_;
  Duration board_minus_monotonic_;
  ButtonFrames frames_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

// Of "socketcan:IF", started; null for a log, which nothing comes from. Throws as open_can_sink.
[[nodiscard]] std::unique_ptr<CanButtons> open_can_buttons(const std::string& specification,
                                                           std::uint32_t identifier,
                                                           Duration unix_minus_board,
                                                           ButtonFrames::OnButton on_button,
                                                           Duration timeout = k_button_timeout);

}  // namespace glint
