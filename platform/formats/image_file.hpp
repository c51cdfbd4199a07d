// Readers and writers of image files: binary PGM (P5), and PNG by libspng.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

struct Image {
  int width = 0;
  int height = 0;
  int channels = 1;                   // 1 grey; 3 red, green, blue; 4 with alpha, if requested
  int bits = 8;                       // per value: 8 or 16
  std::vector<std::uint16_t> values;  // row by row, channels of a pixel interleaved
};

constexpr int k_image_side_max = 16'384;

// Limits on a PGM.
struct PgmLimits {
  int width = k_image_side_max;
  int height = k_image_side_max;
  int bits_min = 8;
};

// At most k_image_side_max pixels per side and 64 million in total. Values of a PGM are not
// scaled by its maxval. A PNG's palette is expanded to colours, 1 to 4 bits become 8, alpha is
// dropped unless `transparency`. Throws InputError that states the file, the position, found and
// expected.
[[nodiscard]] Image read_pgm(const std::string& path, const PgmLimits& limits = {});
[[nodiscard]] Image read_png(const std::string& path, const std::string& expected);
// Same for a file's bytes in memory; `path` is for messages.
[[nodiscard]] Image pgm_of(std::string_view bytes, const std::string& path,
                           const PgmLimits& limits = {});
[[nodiscard]] Image png_of(std::string_view bytes, const std::string& path,
                           const std::string& expected, bool transparency = false);
// Reads either format, selected by the first bytes.
[[nodiscard]] Image read_image_file(const std::string& path);

// Writes a PNG with 8 bits per value. values: width * height * channels, row by row. Throws
// InputError that names the file if it cannot be written; `expected` ends the message.
void write_png(const std::string& path, int width, int height, int channels,
               const std::uint8_t* values, const std::string& expected);

// Throws InputError if the image exceeds the limits; `place` is the position in the file.
void check_image_size(const std::string& path, std::size_t place, std::uint64_t width,
                      std::uint64_t height);

}  // namespace glint
