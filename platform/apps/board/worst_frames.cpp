#include "platform/apps/board/worst_frames.hpp"

namespace glint {
namespace {

constexpr int k_marker_pitch = 16;  // pixels between the centres of drawn markers
constexpr int k_marker_radius = 5;  // of a 10 mm ball at 0.5 m, rounded up

// Hash of a pixel's index: the finaliser of MurmurHash3 (Appleby, public domain).
std::uint32_t hashed(std::uint32_t value) {
  value ^= value >> 16;
  value *= 0x85EBCA6Bu;
  value ^= value >> 13;
  value *= 0xC2B2AE35u;
  return value ^ (value >> 16);
}

bool in_marker(int x, int y) {
  const int dx = x % k_marker_pitch - k_marker_pitch / 2;
  const int dy = y % k_marker_pitch - k_marker_pitch / 2;
  return dx * dx + dy * dy <= k_marker_radius * k_marker_radius;
}

bool is_bright(WorstFrame kind, int x, int y, int width) {
  switch (kind) {
    case WorstFrame::all_bright:
      return true;
    case WorstFrame::comb:
      return x % 2 == 0;
    case WorstFrame::dots:
      return x % 2 == 0 && y % 2 == 0;
    case WorstFrame::checkerboard:
      return (x + y) % 2 == 0;
    case WorstFrame::markers:
      return in_marker(x, y);
    case WorstFrame::noise:
      return (hashed(static_cast<std::uint32_t>(y * width + x)) & 1u) != 0;
  }
  return false;
}

}  // namespace

std::string_view name_of(WorstFrame kind) {
  constexpr std::string_view names[k_worst_frames] = {"all_bright",   "comb",    "dots",
                                                      "checkerboard", "markers", "noise"};
  return names[static_cast<std::size_t>(kind)];
}

void draw(WorstFrame kind, std::uint16_t bright, std::uint16_t dark, std::uint16_t depth,
          FrameBuffer& pixels) {
  std::size_t at = 0;
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x, ++at) {
      const std::uint16_t value = is_bright(kind, x, y, pixels.width) ? bright : dark;
      if (!pixels.reflectivity_8.empty()) {
        pixels.reflectivity_8[at] = static_cast<std::uint8_t>(value);
      } else {
        pixels.reflectivity_16[at] = value;
      }
      if (!pixels.depth.empty()) pixels.depth[at] = depth;
    }
  }
}

}  // namespace glint
