// Pictures in files: binary PGM (P5), and PNG by libspng.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

struct Picture {
  int width = 0;
  int height = 0;
  int channels = 1;  // 1 grey; 3 red, green, blue; 4 with transparency, where asked for
  int bits = 8;      // a value: 8 or 16
  std::vector<std::uint16_t> values;  // row by row, a pixel's channels beside each other
};

constexpr int k_picture_side_max = 16'384;

// What a PGM may hold.
struct PgmLimits {
  int width = k_picture_side_max;
  int height = k_picture_side_max;
  int bits_min = 8;
};

// At most k_picture_side_max pixels a side and 64 million in all. A PGM's values are not scaled by
// its maxval. A PNG's palette becomes colours, 1 to 4 bits become 8, transparency is dropped unless
// `transparency`. Throw InputError naming the file, the place, what was found and expected.
[[nodiscard]] Picture read_pgm(const std::string& path, const PgmLimits& limits = {});
[[nodiscard]] Picture read_png(const std::string& path, const std::string& expected);
// The same of a file's bytes in memory; `path` is for messages.
[[nodiscard]] Picture pgm_of(std::string_view bytes, const std::string& path,
                             const PgmLimits& limits = {});
[[nodiscard]] Picture png_of(std::string_view bytes, const std::string& path,
                             const std::string& expected, bool transparency = false);
// Either, by how it begins.
[[nodiscard]] Picture read_picture(const std::string& path);

// Writes a PNG with 8 bits a value; `values`: width * height * channels of them, row by row.
// Throws InputError naming the file if it cannot be written; `expected` ends the message.
void write_png(const std::string& path, int width, int height, int channels,
               const std::uint8_t* values, const std::string& expected);

// Throws InputError: more pixels than are read, at `place` of the file.
void check_picture_size(const std::string& path, std::size_t place, std::uint64_t width,
                        std::uint64_t height);

}  // namespace glint
