// Poses and button presses for the tests of paths.
#pragma once

#include <cmath>
#include <cstdint>

#include "kernels/wire/pose_sample.hpp"
#include "platform/tools/programming/path_capture.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint {

inline Time at_ms(double ms) { return Time{std::llround(ms * 1e6)}; }

inline PoseSample tip_at(double ms, const Vector3& place,
                         const Quaternion& rotation = Quaternion::Identity()) {
  PoseSample sample;
  sample.tick = at_ms(ms);
  sample.measurement = sample.tick - milliseconds(5);
  sample.tick_number = static_cast<std::uint32_t>(sample.tick.nanoseconds / 4'000'000);
  sample.state = TrackState::measured;
  sample.reason = Reason::none;
  sample.frame = ReferenceFrame::robot;
  sample.pose = {rotation, place};
  sample.covariance = Matrix6::Identity() * 1e-8;
  return sample;
}

inline ButtonEvent down(double ms, Button button = Button::draw) {
  return {at_ms(ms), button, true};
}
inline ButtonEvent up(double ms, Button button = Button::draw) {
  return {at_ms(ms), button, false};
}

inline void press(PathCapture& capture, double ms, Button button) {
  capture.add(down(ms, button));
  capture.add(up(ms + 50, button));
}

// Presses the button from `from` to `to`; every 4 ms the tip is at `place(ms)`.
template <class Place>
void draw(PathCapture& capture, double from, double to, Place place) {
  capture.add(down(from));
  for (double ms = from; ms <= to; ms += 4) capture.add(tip_at(ms, place(ms)));
  capture.add(up(to));
}

// A straight stroke along x at 100 mm/s, and a click.
inline void draw_line(PathCapture& capture, double from, double to, double y = 0) {
  draw(capture, from, to, [&](double ms) { return Vector3(1e-4 * (ms - from), y, 0.2); });
}
inline void click(PathCapture& capture, double ms, const Vector3& place) {
  draw(capture, ms, ms + 100, [&](double) { return place; });
}

}  // namespace glint
