// Memory that the program and its DDS process share: two rings of records and the state of each
// endpoint.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <type_traits>

#include "kernels/units.hpp"
#include "platform/sinks/dds/participant.hpp"
#include "platform/sinks/dds/shared_ring.hpp"

namespace glint {

inline constexpr std::size_t k_endpoints_max = 128;  // 16 tools have 76
inline constexpr int k_memory_descriptor = 3;        // of the DDS process

// A RecordKind::create's contents.
struct NewEndpoint {
  bool is_writer = false;
  std::array<char, 64> type{};    // name of the type, zero-terminated
  std::array<char, 256> topic{};  // zero-terminated
  Quality quality;
  std::uint32_t bytes_max = 0;       // of a received message; larger ones are refused
  std::uint32_t readers_before = 0;  // matched readers before the last process ended
};
static_assert(std::is_trivially_copyable_v<NewEndpoint>);

// A RecordKind::flush's contents.
struct Flush {
  std::uint32_t number = 0;
  std::int64_t limit_ns = 0;
};

// Written by the DDS process only.
struct EndpointState {
  std::atomic<std::uint64_t> published{0};     // messages given to DDS
  std::atomic<std::uint64_t> failed{0};        // messages not published
  std::atomic<std::uint64_t> refused{0};       // received messages above bytes_max
  std::atomic<std::uint64_t> overwritten{0};   // received messages for which there was no room
  std::atomic<std::uint64_t> lost{0};          // messages that DDS lost in transport
  std::atomic<std::uint32_t> incompatible{0};  // publishers with another quality of service
  std::atomic<std::uint32_t> matched{0};       // discovered counterparts
  std::atomic<std::uint32_t> ready{0};         // 1: publishes, see ServedEndpoints
};

struct ProcessMemory {
  std::uint64_t outgoing_bytes = 0, incoming_bytes = 0;  // sizes of the rings
  RingPositions outgoing, incoming;
  std::atomic<std::uint32_t> to_process{0}, to_program{0};  // futexes: changed after each push
  std::atomic<std::uint64_t> beat{0};                       // advances while the process runs
  std::atomic<std::uint32_t> joined{0};                     // 1: the participant exists
  std::atomic<std::uint32_t> flushed{0};                    // number of the last flush
  std::array<char, 256> error{};                            // why it could not join
  std::array<EndpointState, k_endpoints_max> endpoints;
};

// The mapped memory. Both throw MissingDevice.
class SharedMemory {
 public:
  // A new one, without a name in the file system.
  SharedMemory(std::size_t outgoing_bytes, std::size_t incoming_bytes);
  // The one behind a descriptor.
  explicit SharedMemory(int descriptor);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  // Empties both rings and all states. No other process may use the memory.
  void reset() noexcept;

  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
  [[nodiscard]] ProcessMemory& state() const noexcept {
    return *static_cast<ProcessMemory*>(address_);
  }
  [[nodiscard]] std::span<std::uint8_t> outgoing() const noexcept;
  [[nodiscard]] std::span<std::uint8_t> incoming() const noexcept;

 private:
  void map();

  int descriptor_;
  std::size_t outgoing_bytes_ = 0, incoming_bytes_ = 0;
  void* address_ = nullptr;
};

}  // namespace glint
