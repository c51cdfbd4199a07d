// Error frames of a CAN interface, counted by kind in a thread of its own: what its driver reports
// of the bus.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include "platform/descriptor.hpp"

struct can_frame;

namespace glint {

struct CanErrorCounts {
  std::uint64_t bus_off = 0;    // the controller left the bus: frames are lost until it restarts
  std::uint64_t restarted = 0;  // it returned
  std::uint64_t passive = 0;    // error passive, or its warning level
  std::uint64_t overflow = 0;   // of the controller's buffers
  std::uint64_t no_acknowledge = 0;
  std::uint64_t other = 0;  // of the protocol, the transceiver, a transmission that timed out
};

// Adds an error frame (linux/can/error.h), once for each kind that it contains.
void count_error(const can_frame& frame, CanErrorCounts& counts) noexcept;

class CanErrors {
 public:
  // `socket` returns one error frame per read, as open_can_errors makes it.
  explicit CanErrors(Descriptor socket);
  ~CanErrors();
  CanErrors(const CanErrors&) = delete;
  CanErrors& operator=(const CanErrors&) = delete;

  // From any thread.
  [[nodiscard]] CanErrorCounts counts() const noexcept;

 private:
  void read_until_stopped() noexcept;

  Descriptor socket_;
  std::atomic<std::uint64_t> bus_off_{0}, restarted_{0}, passive_{0}, overflow_{0},
      no_acknowledge_{0}, other_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;  // last: it uses all of the above
};

// Throws as open_socketcan.
[[nodiscard]] Descriptor open_can_errors(const std::string& interface);

}  // namespace glint
