#include "platform/sensors/read_picture.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string_view>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr std::uint32_t k_side_max = 16'384;
constexpr std::uint64_t k_pixels_max = 64'000'000;
constexpr std::string_view k_png = "\x89PNG\r\n\x1A\n";
constexpr std::size_t k_width_at = 16, k_height_at = 20;  // in the first chunk, IHDR

void check_png_size(const std::string& path) {
  std::array<char, k_height_at + 4> head{};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(head.data(), head.size()) ||
      !std::string_view(head.data(), 8).starts_with(k_png)) {
    return;
  }
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value = value << 8 | static_cast<std::uint8_t>(head[at + i]);
    return value;
  };
  const std::uint32_t width = number(k_width_at), height = number(k_height_at);
  if (width > k_side_max || height > k_side_max || std::uint64_t{width} * height > k_pixels_max) {
    throw InputError(path + ":byte 16: " + std::to_string(width) + " x " + std::to_string(height) +
                     " pixels; expected at most " + std::to_string(k_side_max) + " a side and " +
                     std::to_string(k_pixels_max) + " in all");
  }
}

}  // namespace

cv::Mat read_picture(const std::string& path, int flags, const std::string& expected) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) {
    throw InputError(path + ": cannot be opened; expected " + expected);
  }
  check_png_size(path);
  cv::Mat picture;
  try {
    picture = cv::imread(path, flags);
  } catch (const cv::Exception&) {
    picture.release();
  }
  if (picture.empty()) throw InputError(path + ": no picture; expected " + expected);
  return picture;
}

}  // namespace glint
