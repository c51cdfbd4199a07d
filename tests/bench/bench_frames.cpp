#include "bench_frames.hpp"

#include "platform/sim/scenarios.hpp"

namespace glint::bench {
namespace {

// Larger than the processor's cache: every frame is read from memory, as from a camera.
constexpr int k_frames = 64;

Sensor make_sensor(std::string name, const sim::Scenario& scenario, int first) {
  Sensor sensor;
  sensor.name = std::move(name);
  sensor.camera = scenario.camera;
  sensor.tool = scenario.tools.front().tool;
  const sim::Simulator simulator(scenario);
  sensor.frames.resize(k_frames);
  for (int i = 0; i < k_frames; ++i)
    simulator.render(first + i, sensor.frames[static_cast<std::size_t>(i)]);
  return sensor;
}

}  // namespace

const Sensor& short_throw() {
  // Three seconds after the static part that aligns the worlds: head and pen in full motion.
  static const Sensor sensor =
      make_sensor("448x450 8 bit", sim::experiment_dynamic(0), sim::k_aligning_frames + 90);
  return sensor;
}

const Sensor& ahat() {
  // Ten seconds into the default run: 45 Hz, hands and clutter, no event.
  static const Sensor sensor = make_sensor("512x512 16 bit", sim::default_run(), 450);
  return sensor;
}

void Player::next() {
  const sim::SimFrame& shown = sensor_->frames[at_];
  ++sequence_;
  const Time now{static_cast<std::int64_t>(sequence_) * sensor_->camera.period.nanoseconds};
  frame_ = shown.pixels.view(now, now, sequence_);
  head_ = shown.head;
  head_.time = now;
  if (back_ ? at_ == 0 : at_ + 1 == sensor_->frames.size()) {
    back_ = !back_;  // the last frame of each direction repeats: one static frame
  } else {
    at_ = back_ ? at_ - 1 : at_ + 1;
  }
}

}  // namespace glint::bench
