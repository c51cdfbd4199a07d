// receive_buttons INTERFACE IDENTIFIER FRAMES: receives FRAMES button frames and prints each
// change: the button (0 draw, 1 delete_last, 2 undo, 3 finish) and whether it is pressed. Exit 0:
// all received, each time stamp between start and end; 1: otherwise; 3: the interface is missing.
// Used by tests/hil/guest.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "platform/input_error.hpp"
#include "platform/sinks/can/can_buttons.hpp"

namespace {

using namespace glint;

constexpr int k_polls_max = 10'000;  // of 2 ms
constexpr std::chrono::milliseconds k_poll_period{2};

Time unix_now() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return Time{std::chrono::duration_cast<std::chrono::nanoseconds>(now).count()};
}

int count_button_frames(const std::string& interface, std::uint32_t identifier,
                        std::uint64_t frames) {
  const Time start = unix_now();
  std::atomic<bool> stamps_hold{true};
  const auto buttons =
      open_can_buttons("socketcan:" + interface, identifier, {}, [&](const ButtonEvent& event) {
        std::printf("%d %d\n", static_cast<int>(event.button), event.pressed);
        if (event.time < start || event.time > unix_now()) stamps_hold = false;
      });
  const auto all = [&] { return buttons->counts().received + buttons->counts().refused; };
  for (int look = 0; all() < frames && look < k_polls_max; ++look) {
    std::this_thread::sleep_for(k_poll_period);
  }
  buttons->stop();
  std::printf("received %llu, refused %llu\n",
              static_cast<unsigned long long>(buttons->counts().received),
              static_cast<unsigned long long>(buttons->counts().refused));
  return all() == frames && stamps_hold ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  try {
    return count_button_frames(arguments[1],
                               static_cast<std::uint32_t>(std::strtoul(arguments[2], nullptr, 0)),
                               std::strtoull(arguments[3], nullptr, 0));
  } catch (const MissingDevice& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
