#include "platform/sinks/can/button_frames.hpp"

#include <linux/can.h>

#include <algorithm>
#include <cstring>

#include "kernels/wire/can_messages.hpp"

namespace glint {
namespace {

constexpr const CanMessageLayout& k_buttons_message = can_message("PenButtons");
static_assert(k_buttons_message.signals.size() == k_button_count);

}  // namespace

std::optional<CanFrame> frame_of_socketcan(std::span<const std::uint8_t> bytes) {
  if (bytes.size() != CAN_MTU && bytes.size() != CANFD_MTU) return {};
  canfd_frame raw{};  // a classic frame has the same fields at the same offsets
  std::memcpy(&raw, bytes.data(), bytes.size());
  if ((raw.can_id & (CAN_RTR_FLAG | CAN_ERR_FLAG)) != 0) return {};
  CanFrame frame;
  frame.fd = bytes.size() == CANFD_MTU;
  if (raw.len > (frame.fd ? CANFD_MAX_DLEN : CAN_MAX_DLEN)) return {};
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.identifier = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.bit_rate_switch = frame.fd && (raw.flags & CANFD_BRS) != 0;
  frame.length = raw.len;
  std::copy_n(raw.data, raw.len, frame.data.begin());
  return frame;
}

ButtonFrames::ButtonFrames(std::uint32_t identifier, OnButton on_button, Duration timeout)
    : identifier_(identifier), on_button_(std::move(on_button)), timeout_(timeout) {}

void ButtonFrames::receive(const std::optional<CanFrame>& frame, Time arrived) {
  if (!frame || frame->extended || frame->identifier != identifier_ || frame->length == 0) {
    refused_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  received_.fetch_add(1, std::memory_order_relaxed);
  last_ = arrived;
  for (std::size_t i = 0; i < held_.size(); ++i) {
    const bool now = unsigned_of(frame->bytes(), k_buttons_message.signals[i]) != 0;
    if (now == held_[i]) continue;
    held_[i] = now;
    if (on_button_) on_button_({arrived, static_cast<Button>(i), now});
  }
}

void ButtonFrames::release_on_timeout(Time now) {
  if (now - last_ <= timeout_) return;
  for (std::size_t i = 0; i < held_.size(); ++i) {
    if (!held_[i]) continue;
    held_[i] = false;
    released_.fetch_add(1, std::memory_order_relaxed);
    if (on_button_) on_button_({now, static_cast<Button>(i), false});
  }
}

ButtonFrameCounts ButtonFrames::counts() const noexcept {
  return {received_.load(std::memory_order_relaxed), refused_.load(std::memory_order_relaxed),
          released_.load(std::memory_order_relaxed)};
}

}  // namespace glint
