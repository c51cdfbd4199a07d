// Output of CAN frames to a bus or a log file; `send` neither blocks nor allocates.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "kernels/units.hpp"
#include "kernels/wire/can_frame.hpp"
#include "platform/sinks/can/can_errors.hpp"
#include "platform/when_full.hpp"

namespace glint {

struct CanSinkCounts {
  std::uint64_t sent = 0;           // accepted by the kernel, or written to the log
  std::uint64_t dropped = 0;        // the queue was full: the bus or the disk is too slow
  std::uint64_t failed = 0;         // rejected by the bus or the disk (down, disk full, no CAN FD)
  int error = 0;                    // errno of the first that failed
  std::uint64_t sets_replaced = 0;  // refused sets of begin_set: a later one was sent
  CanErrorCounts bus{};             // error frames
  // A bus that a controller left loses frames that the kernel accepted: at least one each time.
  [[nodiscard]] bool all_sent() const { return lost() == 0; }
  [[nodiscard]] std::uint64_t lost() const { return dropped + failed + bus.bus_off; }
};

// Maximum number of frames that send() accepted and that are not yet counted as sent or failed.
inline constexpr std::size_t k_can_in_flight_max = 16384 + 256;

class CanSink {
 public:
  virtual ~CanSink() = default;

  // Before the frames of one estimate, or before a frame that belongs to none. A bus whose queue is
  // full refuses such a set as a whole, or sends all of it, the rest when there is space: a
  // controller receives complete estimates, and the next one is the newest.
  virtual void begin_set() noexcept {}

  // From one thread. `time` is the send time on the companion computer's monotonic clock; a log
  // stores it, a bus ignores it. Errors are counted. Returns false if the frame is lost. Of the
  // accepted frames the first counts().sent were sent: a log stops writing after its first error.
  virtual bool send(const CanFrame& frame, Time time) noexcept = 0;

  // Returns after all frames sent so far have left this process. May block: not for the hot path.
  virtual void flush() noexcept = 0;

  // From any thread.
  [[nodiscard]] virtual CanSinkCounts counts() const noexcept = 0;
};

struct CanSinkOptions {
  std::filesystem::path directory;        // relative log files go here
  std::int64_t unix_offset_ns = 0;        // Unix time - monotonic time, for the log
  std::string log_interface = "can0";     // interface name in the log
  CanFormat format = CanFormat::classic;  // fd: the interface must carry 64-byte frames
  OverflowPolicy when_full = OverflowPolicy::drop;
  int frames_a_tick = 16;  // the queue of a bus holds about so many: no older estimates wait there
};

// "socketcan:IF" or "log:FILE" (candump -L format). Throws InputError for another specification or
// a file that cannot be created. Throws MissingDevice, with its name, for an interface that does
// not exist, is down, is not CAN or has no CAN FD.
[[nodiscard]] std::unique_ptr<CanSink> open_can_sink(const std::string& specification,
                                                     const CanSinkOptions& options = {});

}  // namespace glint
