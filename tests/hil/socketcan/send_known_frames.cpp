// send_known_frames LOG_INTERFACE SINK...: sends the same frames to every sink, one pose per
// millisecond. Exit 0: all sent; 1: some not sent; 3: an interface is missing. Used by
// tests/hil/guest.
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>
#include <vector>

#include "kernels/wire/can_frames.hpp"
#include "kernels/wire/node_frames.hpp"
#include "platform/input_error.hpp"
#include "platform/sinks/can/can_sink.hpp"
#include "tests/unit/kernels/wire/samples.hpp"

namespace {

using namespace glint;

constexpr int k_samples = 300;

CanFrame extended_frame(int number) {
  CanFrame frame;
  frame.identifier = 0x18FFA000U + static_cast<std::uint32_t>(number);
  frame.extended = true;
  frame.length = static_cast<std::uint8_t>(number % 9);
  frame.data.fill(static_cast<std::uint8_t>(number));
  return frame;
}

CanFrames frames_of(int number, std::mt19937& random) {
  const PoseSample sample = random_sample(random);
  CanFrames frames;
  add_pose_frames(sample, {.format = CanFormat::classic}, frames);
  add_pose_frames(sample, {.format = CanFormat::fd}, frames);
  frames.add(heartbeat_frame(32, CanNodeState::operational));
  frames.add(emergency_frame(32, sample));
  frames.add(extended_frame(number));
  CanFrame slow = frames.items[5];  // an FD frame without bit rate switching
  slow.bit_rate_switch = false;
  frames.add(slow);
  return frames;
}

int send(int count, char** arguments) {
  CanSinkOptions options;
  options.log_interface = arguments[1];
  options.format = CanFormat::fd;
  options.when_full = OverflowPolicy::wait;
  std::vector<std::unique_ptr<CanSink>> sinks;
  for (int i = 2; i < count; ++i) sinks.push_back(open_can_sink(arguments[i], options));

  std::mt19937 random(61);
  for (int i = 0; i < k_samples; ++i) {
    const CanFrames frames = frames_of(i, random);
    for (const CanFrame& frame : frames.frames())
      for (const auto& sink : sinks) sink->send(frame, {});
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  bool all_sent = true;
  for (std::size_t i = 0; i < sinks.size(); ++i) {
    sinks[i]->flush();
    const CanSinkCounts counts = sinks[i]->counts();
    std::printf("%s: sent %llu, dropped %llu, failed %llu\n", arguments[i + 2],
                static_cast<unsigned long long>(counts.sent),
                static_cast<unsigned long long>(counts.dropped),
                static_cast<unsigned long long>(counts.failed));
    all_sent = all_sent && counts.all_sent();
  }
  return all_sent ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) return 2;
  try {
    return send(count, arguments);
  } catch (const MissingDevice& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
