#include "platform/sinks/can/can_errors.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <poll.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <utility>

#include "platform/sinks/can/socketcan_socket.hpp"

namespace glint {
namespace {

constexpr int k_error_poll_ms = 20;
constexpr int k_errors_per_wakeup_max = 256;
constexpr unsigned k_named_kinds = CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_CRTL | CAN_ERR_ACK;

}  // namespace

void count_error(const can_frame& frame, CanErrorCounts& counts) noexcept {
  if ((frame.can_id & CAN_ERR_FLAG) == 0) return;
  const unsigned kinds = frame.can_id & CAN_ERR_MASK;
  const unsigned controller = (kinds & CAN_ERR_CRTL) != 0 ? frame.data[1] : 0U;
  const unsigned overflow = CAN_ERR_CRTL_RX_OVERFLOW | CAN_ERR_CRTL_TX_OVERFLOW;
  const unsigned passive = CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING |
                           CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE;
  if ((kinds & CAN_ERR_BUSOFF) != 0) ++counts.bus_off;
  if ((kinds & CAN_ERR_RESTARTED) != 0) ++counts.restarted;
  if ((controller & passive) != 0) ++counts.passive;
  if ((controller & overflow) != 0) ++counts.overflow;
  if ((kinds & CAN_ERR_ACK) != 0) ++counts.no_acknowledge;
  if ((kinds & ~k_named_kinds) != 0) ++counts.other;
}

CanErrors::CanErrors(Descriptor socket)
    : socket_(std::move(socket)), thread_([this] { read_until_stopped(); }) {
  pthread_setname_np(thread_.native_handle(), "glint_can_error");
}

CanErrors::~CanErrors() {
  stop_ = true;
  thread_.join();
}

void CanErrors::read_until_stopped() noexcept {
  CanErrorCounts counts;
  while (!stop_) {
    pollfd waiting{socket_.get(), POLLIN, 0};
    if (::poll(&waiting, 1, k_error_poll_ms) <= 0) continue;
    can_frame frame{};
    int taken = 0;
    while (taken < k_errors_per_wakeup_max &&
           ::read(socket_.get(), &frame, sizeof frame) == sizeof frame) {
      count_error(frame, counts);
      ++taken;
    }
    bus_off_ = counts.bus_off;
    restarted_ = counts.restarted;
    passive_ = counts.passive;
    overflow_ = counts.overflow;
    no_acknowledge_ = counts.no_acknowledge;
    other_ = counts.other;
    // The socket of an interface that is down or removed is always readable, without data.
    if (taken == 0) std::this_thread::sleep_for(std::chrono::milliseconds(k_error_poll_ms));
  }
}

CanErrorCounts CanErrors::counts() const noexcept {
  return {bus_off_, restarted_, passive_, overflow_, no_acknowledge_, other_};
}

Descriptor open_can_errors(const std::string& interface) {
  Descriptor socket = open_socketcan(interface, CanFormat::classic);
  // Lost arbitration is no error: frames of a smaller identifier were sent first.
  const can_err_mask_t kinds = CAN_ERR_MASK & ~static_cast<can_err_mask_t>(CAN_ERR_LOSTARB);
  ::setsockopt(socket.get(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &kinds, sizeof kinds);
  return socket;
}

}  // namespace glint
