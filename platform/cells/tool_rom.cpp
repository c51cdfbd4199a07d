#include <bit>
#include <cmath>
#include <cstdint>

#include "platform/cells/tool_formats.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr std::size_t k_sum_at = 4;
constexpr std::size_t k_summed_from = 6;
constexpr std::size_t k_count_at = 28;
constexpr std::size_t k_markers_at = 72;
constexpr std::size_t k_marker_bytes = 12;

std::uint32_t little_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  }
  return value;
}

std::string at(const std::string& path, std::size_t byte) {
  return path + ":byte " + std::to_string(byte);
}

}  // namespace

Tool tool_from_rom_bytes(std::string_view bytes, const std::string& path) {
  if (bytes.size() < k_markers_at || bytes.substr(0, 3) != "NDI") {
    throw InputError(at(path, 0) +
                     ": is not an NDI tool definition; expected the letters NDI and at least " +
                     std::to_string(k_markers_at) + " bytes");
  }
  std::uint32_t sum = 0;
  for (std::size_t i = k_summed_from; i < bytes.size(); ++i) {
    sum = (sum + little_endian(bytes, i, 1)) & 0xFFFF;
  }
  const std::uint32_t stated = little_endian(bytes, k_sum_at, 2);
  if (sum != stated) {
    throw InputError(at(path, k_sum_at) + ": checksum " + std::to_string(stated) +
                     " but the sum of the bytes is " + std::to_string(sum) +
                     "; expected an unchanged, complete file");
  }
  const std::uint32_t count = little_endian(bytes, k_count_at, 1);
  check_marker_count(count, at(path, k_count_at));
  if (bytes.size() < k_markers_at + count * k_marker_bytes) {
    throw InputError(at(path, bytes.size()) + ": ends here; expected " + std::to_string(count) +
                     " markers of 12 bytes from byte 72");
  }
  Tool tool;
  set_name(tool, stem_of(path), path);
  for (std::size_t m = 0; m < count; ++m) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t place = k_markers_at + m * k_marker_bytes + axis * 4;
      const auto value = static_cast<double>(std::bit_cast<float>(little_endian(bytes, place, 4)));
      if (!(std::abs(value) <= k_tool_coordinate_max_mm)) {
        throw InputError(at(path, place) + ": marker " + std::to_string(m + 1) +
                         " has a coordinate of " + std::to_string(value) +
                         "; expected -2000 to 2000 mm");
      }
      tool.markers_m[m](static_cast<int>(axis)) = 1e-3 * value;
    }
  }
  tool.marker_count = static_cast<int>(count);
  tool.marker_radius_m = 1e-3 * k_passive_sphere_radius_mm;
  return prepared(tool, at(path, k_markers_at));
}

}  // namespace glint
