#include "kernels/wire/node_frames.hpp"

#include "kernels/wire/bits.hpp"
#include "kernels/wire/crc.hpp"

namespace glint {
namespace {

constexpr std::int64_t k_second_ns = 1'000'000'000;
constexpr std::int64_t k_seconds_max = 0xFFFFFFFF;
constexpr std::int64_t k_overflow_seconds_max = 3;
constexpr std::uint32_t k_node_mask = 0x7F;
constexpr const CanMessageLayout& k_heartbeat_message = can_message("Heartbeat");
constexpr const CanMessageLayout& k_emergency_message = can_message("Emergency");
constexpr const CanMessageLayout& k_sync_message = can_message("TimeSync");
constexpr const CanMessageLayout& k_follow_up_message = can_message("TimeFollowUp");
constexpr std::uint8_t k_generic_and_manufacturer = 0x81;

CanFrame node_frame(const CanMessageLayout& message, unsigned node) {
  return frame_of(message, identifier_of(message, {.node = node & k_node_mask}));
}

// Type, domain and counter, which both time frames have alike.
CanFrame time_frame(const CanMessageLayout& message, const TimeSync& sync, const CanSignal& type,
                    std::uint8_t counter) {
  constexpr const CanMessageLayout& m = k_sync_message;
  CanFrame frame = frame_of(message, identifier_of(message, {.base = sync.base_identifier}));
  put(frame.data, type, type.names[0].value);
  put(frame.data, m.signal("Domain"), sync.domain);
  put(frame.data, m.signal("SequenceCounter"), counter);
  return frame;
}

void protect_time(const TimeSync& sync, std::uint8_t counter, CanFrame& frame) {
  const std::span<const std::uint8_t> data_id(&sync.data_ids[counter & 0xFU], 1);
  put(frame.data, k_sync_message.signal("Crc"),
      crc8_h2f_step(crc8_h2f_step(k_crc8_start, frame.bytes().subspan(2)), data_id) ^
          k_crc8_final_xor);
}

void put_error(std::uint32_t code, CanFrame& frame) {
  put(frame.data, k_emergency_message.signal("ErrorCode"), code);
  put(frame.data, k_emergency_message.signal("ErrorRegister"), k_generic_and_manufacturer);
}

}  // namespace

CanFrame heartbeat_frame(unsigned node, CanNodeState state) noexcept {
  CanFrame frame = node_frame(k_heartbeat_message, node);
  put(frame.data, k_heartbeat_message.signal("NodeState"), static_cast<std::uint8_t>(state));
  return frame;
}

CanFrame emergency_frame(unsigned node, const PoseSample& sample) noexcept {
  constexpr const CanMessageLayout& m = k_emergency_message;
  CanFrame frame = node_frame(m, node);
  const auto reason = static_cast<std::uint8_t>(sample.reason);
  if (sample.reason != Reason::none) put_error(k_can_error_reason + reason, frame);
  put(frame.data, m.signal("Tool"), sample.tool);
  put(frame.data, m.signal("State"), static_cast<std::uint8_t>(sample.state));
  put(frame.data, m.signal("Reason"), reason);
  put(frame.data, m.signal("Registration"), static_cast<std::uint8_t>(sample.registration));
  return frame;
}

CanFrame overrun_frame(unsigned node, const OverrunEmergency& overrun) noexcept {
  constexpr const CanMessageLayout& m = k_emergency_message;
  CanFrame frame = node_frame(m, node);
  const auto reason = static_cast<std::uint8_t>(overrun.reason);
  put_error(k_can_error_reason + reason, frame);
  put(frame.data, m.signal("RateGroup"), overrun.group);
  put(frame.data, m.signal("Overrun"), overrun.kind);
  put(frame.data, m.signal("Reason"), reason);
  put(frame.data, m.signal("AfterNode"), overrun.after_node);
  return frame;
}

CanFrame lost_output_frame(unsigned node, std::uint8_t kind) noexcept {
  CanFrame frame = node_frame(k_emergency_message, node);
  put_error(k_can_error_lost_output + kind, frame);
  put(frame.data, k_emergency_message.signal("LostOutput"), kind);
  return frame;
}

Result<CanFrame> time_sync_frame(const TimeSync& sync, std::uint8_t counter,
                                 std::int64_t unix_ns) noexcept {
  if (unix_ns < 0 || unix_ns / k_second_ns > k_seconds_max) return {{}, Reason::out_of_range};
  CanFrame frame = time_frame(k_sync_message, sync, k_sync_message.signal("Type"), counter);
  put(frame.data, k_sync_message.signal("Seconds"),
      static_cast<std::uint64_t>(unix_ns / k_second_ns));
  protect_time(sync, counter, frame);
  return {frame, Reason::none};
}

Result<CanFrame> time_follow_up_frame(const TimeSync& sync, std::uint8_t counter,
                                      std::int64_t sync_unix_ns,
                                      std::int64_t sent_unix_ns) noexcept {
  if (sync_unix_ns < 0 || sent_unix_ns < 0) return {{}, Reason::out_of_range};
  const std::int64_t seconds = sent_unix_ns / k_second_ns - sync_unix_ns / k_second_ns;
  if (seconds < 0 || seconds > k_overflow_seconds_max) return {{}, Reason::out_of_range};
  constexpr const CanMessageLayout& m = k_follow_up_message;
  CanFrame frame = time_frame(m, sync, m.signal("Type"), counter);
  put(frame.data, m.signal("OverflowSeconds"), static_cast<std::uint64_t>(seconds));
  put(frame.data, m.signal("Nanoseconds"), static_cast<std::uint64_t>(sent_unix_ns % k_second_ns));
  protect_time(sync, counter, frame);
  return {frame, Reason::none};
}

}  // namespace glint
