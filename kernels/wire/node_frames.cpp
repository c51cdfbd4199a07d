#include "kernels/wire/node_frames.hpp"

#include "kernels/wire/bits.hpp"
#include "kernels/wire/crc.hpp"

namespace glint {
namespace {

constexpr std::int64_t k_second_ns = 1'000'000'000;
constexpr std::int64_t k_seconds_max = 0xFFFFFFFF;
constexpr std::int64_t k_overflow_seconds_max = 3;
constexpr std::uint32_t k_emergency = 0x080;
constexpr std::uint32_t k_heartbeat = 0x700;
constexpr std::uint32_t k_node_mask = 0x7F;
constexpr std::uint16_t k_device_specific = 0xFF00;
constexpr std::uint8_t k_generic_and_manufacturer = 0x81;
constexpr std::uint8_t k_sync_with_crc = 0x20;
constexpr std::uint8_t k_follow_up_with_crc = 0x28;

CanFrame time_frame(const TimeSync& sync, std::uint32_t offset, std::uint8_t type,
                    std::uint8_t counter, std::uint8_t byte_3, std::int64_t word) {
  CanFrame frame;
  frame.identifier = sync.base_identifier + offset;
  frame.length = 8;
  frame.data[0] = type;
  frame.data[2] = static_cast<std::uint8_t>((sync.domain & 0xFU) << 4 | (counter & 0xFU));
  frame.data[3] = byte_3;
  put_big_endian(std::span(frame.data).subspan(4, 4), static_cast<std::uint64_t>(word));
  const std::span<const std::uint8_t> data_id(&sync.data_ids[counter & 0xFU], 1);
  frame.data[1] = crc8_h2f_step(crc8_h2f_step(k_crc8_start, frame.bytes().subspan(2)), data_id) ^
                  k_crc8_final_xor;
  return frame;
}

}  // namespace

CanFrame heartbeat_frame(unsigned node, CanNodeState state) noexcept {
  CanFrame frame;
  frame.identifier = k_heartbeat + (node & k_node_mask);
  frame.length = 1;
  frame.data[0] = static_cast<std::uint8_t>(state);
  return frame;
}

CanFrame emergency_frame(unsigned node, const PoseSample& sample) noexcept {
  CanFrame frame;
  frame.identifier = k_emergency + (node & k_node_mask);
  frame.length = 8;
  const auto reason = static_cast<std::uint8_t>(sample.reason);
  if (sample.reason != Reason::none) {
    put_little_endian(std::span(frame.data).first(2), k_device_specific + reason);
    frame.data[2] = k_generic_and_manufacturer;
  }
  frame.data[3] = sample.tool;
  frame.data[4] = static_cast<std::uint8_t>(sample.state);
  frame.data[5] = reason;
  frame.data[6] = static_cast<std::uint8_t>(sample.registration);
  return frame;
}

CanFrame overrun_frame(unsigned node, const OverrunEmergency& overrun) noexcept {
  CanFrame frame;
  frame.identifier = k_emergency + (node & k_node_mask);
  frame.length = 8;
  const auto reason = static_cast<std::uint8_t>(overrun.reason);
  put_little_endian(std::span(frame.data).first(2), k_device_specific + reason);
  frame.data[2] = k_generic_and_manufacturer;
  frame.data[3] = overrun.group;
  frame.data[4] = overrun.kind;
  frame.data[5] = reason;
  frame.data[7] = overrun.after_node;
  return frame;
}

Result<CanFrame> time_sync_frame(const TimeSync& sync, std::uint8_t counter,
                                 std::int64_t unix_ns) noexcept {
  if (unix_ns < 0 || unix_ns / k_second_ns > k_seconds_max) return {{}, Reason::out_of_range};
  return {time_frame(sync, k_can_time_sync, k_sync_with_crc, counter, 0, unix_ns / k_second_ns),
          Reason::none};
}

Result<CanFrame> time_follow_up_frame(const TimeSync& sync, std::uint8_t counter,
                                      std::int64_t sync_unix_ns,
                                      std::int64_t sent_unix_ns) noexcept {
  if (sync_unix_ns < 0 || sent_unix_ns < 0) return {{}, Reason::out_of_range};
  const std::int64_t seconds = sent_unix_ns / k_second_ns - sync_unix_ns / k_second_ns;
  if (seconds < 0 || seconds > k_overflow_seconds_max) return {{}, Reason::out_of_range};
  return {time_frame(sync, k_can_time_follow_up, k_follow_up_with_crc, counter,
                     static_cast<std::uint8_t>(seconds), sent_unix_ns % k_second_ns),
          Reason::none};
}

}  // namespace glint
