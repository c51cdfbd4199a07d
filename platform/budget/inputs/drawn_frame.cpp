#include "platform/budget/inputs/drawn_frame.hpp"

#include <algorithm>
#include <array>

#include "platform/sim/scenarios.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {
namespace {

constexpr std::uint16_t k_dark = 200;
constexpr std::uint16_t k_wall = 900;  // millimetres
constexpr int k_recorded_frames = 8;

// Simulated frames with hands and clutter, one second apart, from ten seconds into the run on.
const std::vector<FrameBuffer>& rendered() {
  static const std::vector<FrameBuffer> frames = [] {
    std::vector<FrameBuffer> out;
    const sim::Simulator simulator(sim::default_run());
    sim::SimFrame frame;
    for (int i = 0; i < k_recorded_frames; ++i) {
      simulator.render(450 + 45 * i, frame);
      out.push_back(frame.pixels);
    }
    return out;
  }();
  return frames;
}

template <class Visit>
void for_each_in_disc(int width, int height, double cx, double cy, double radius, Visit visit) {
  const int x0 = std::max(static_cast<int>(cx - radius), 0);
  const int y0 = std::max(static_cast<int>(cy - radius), 0);
  const int x1 = std::min(static_cast<int>(cx + radius) + 2, width);
  const int y1 = std::min(static_cast<int>(cy + radius) + 2, height);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const double dx = x + 0.5 - cx, dy = y + 0.5 - cy;
      if (dx * dx + dy * dy <= radius * radius) {
        visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
              static_cast<std::size_t>(x));
      }
    }
  }
}

}  // namespace

void DrawnFrame::clear(const Limits& limits) {
  buffer_.width = limits.width;
  buffer_.height = limits.height;
  const auto pixels =
      static_cast<std::size_t>(limits.width) * static_cast<std::size_t>(limits.height);
  buffer_.reflectivity_16.assign(pixels, k_dark);
  buffer_.depth.assign(pixels, k_wall);
  is_narrow_ = limits.reflectivity_bytes == 1;
}

void DrawnFrame::disc(double cx, double cy, double radius, std::uint16_t level) {
  for_each_in_disc(width(), height(), cx, cy, radius,
                   [&](std::size_t at) { buffer_.reflectivity_16[at] = level; });
}

void DrawnFrame::depth_disc(double cx, double cy, double radius, std::uint16_t raw) {
  for_each_in_disc(width(), height(), cx, cy, radius,
                   [&](std::size_t at) { buffer_.depth[at] = raw; });
}

void DrawnFrame::row_run(int y, int x0, int x1, std::uint16_t level) {
  const auto row = buffer_.reflectivity_16.begin() + static_cast<std::ptrdiff_t>(y) * width();
  if (x0 < x1) std::fill(row + x0, row + x1, level);
}

void DrawnFrame::pattern(const RunPattern& p) {
  const int period = p.run + p.gap;
  const int x1 = std::min(p.x1, width()), y1 = std::min(p.y1, height());
  for (int y = std::max(p.y0, 0); y < y1; ++y) {
    if ((y - p.y0) % (p.rows + p.skip) >= p.rows) continue;
    for (int x = p.x0 + (y - p.y0) * p.shift % period; x < x1; x += period) {
      row_run(y, x, std::min(x + p.run, x1), p.level);
    }
  }
}

void DrawnFrame::scene(CounterRandom& random) {
  const auto x = [&] { return random.uniform() * width(); };
  const auto y = [&] { return random.uniform() * height(); };
  const int hands = random.below(3), markers = random.between(3, 25), strays = random.below(41);
  for (int i = 0; i < hands; ++i) {
    disc(x(), y(), random.between(20, 70), static_cast<std::uint16_t>(random.between(800, 4000)));
  }
  for (int i = 0; i < markers + strays; ++i) {
    const double cx = x(), cy = y(), radius = i < markers ? 2 + 8 * random.uniform() : 1.5;
    disc(cx, cy, radius, static_cast<std::uint16_t>(random.between(5'000, 65'535)));
    depth_disc(cx, cy, radius + 1, static_cast<std::uint16_t>(random.between(150, 1000)));
    if (random.below(4) == 0) depth_disc(cx, cy, 0.6 * radius, 0);
  }
}

void DrawnFrame::recorded(CounterRandom& random) {
  const FrameBuffer& from = rendered()[static_cast<std::size_t>(random.below(k_recorded_frames))];
  const int columns = std::min(from.width, width());
  const int first = random.below(from.height);  // rotates rows: markers reach every band
  for (int y = 0; y < height(); ++y) {
    const auto source = static_cast<std::ptrdiff_t>((y + first) % from.height) * from.width;
    const auto target = static_cast<std::ptrdiff_t>(y) * width();
    std::copy_n(from.reflectivity_16.begin() + source, columns,
                buffer_.reflectivity_16.begin() + target);
    std::copy_n(from.depth.begin() + source, columns, buffer_.depth.begin() + target);
  }
  for (int i = random.below(20); i > 0; --i) {
    disc(random.below(width()), random.below(height()), 1.5, k_drawn_bright);
  }
}

Frame DrawnFrame::view() {
  Frame frame = buffer_.view({}, {}, 0);
  if (!is_narrow_) return frame;
  narrow_.resize(buffer_.reflectivity_16.size());
  std::transform(buffer_.reflectivity_16.begin(), buffer_.reflectivity_16.end(), narrow_.begin(),
                 [](std::uint16_t value) { return static_cast<std::uint8_t>(value >> 8); });
  frame.reflectivity_16 = {};
  frame.reflectivity_8 = {narrow_.data(), width(), height()};
  return frame;
}

}  // namespace glint
