#include "platform/formats/image_file.hpp"
#include "platform/input_error.hpp"
#include "platform/read_file.hpp"

namespace glint {
namespace {

constexpr std::uint64_t k_pixels_max = 64'000'000;
constexpr std::size_t k_pgm_bytes_max = 2 * k_pixels_max + 4096;  // plus a header with comments

struct Reader {
  const std::string& path;
  std::string_view bytes;
  std::size_t at = 2;  // after "P5"

  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw InputError(path + ":byte " + std::to_string(at) + ": " + found + "; expected " +
                     expected);
  }

  void skip_blanks_and_comments() {
    while (at < bytes.size()) {
      if (bytes[at] == '#') {
        while (at < bytes.size() && bytes[at] != '\n') ++at;
      } else if (bytes[at] == ' ' || bytes[at] == '\t' || bytes[at] == '\n' || bytes[at] == '\r') {
        ++at;
      } else {
        return;
      }
    }
  }

  int number(const std::string& name, int least, int most) {
    skip_blanks_and_comments();
    const std::string expected =
        name + " from " + std::to_string(least) + " to " + std::to_string(most);
    const std::size_t first = at;
    int value = 0;
    while (at < bytes.size() && bytes[at] >= '0' && bytes[at] <= '9' && at < first + 7) {
      value = value * 10 + (bytes[at++] - '0');
    }
    if (at == first) fail("no number", expected);
    if (value < least || value > most) fail(std::to_string(value), expected);
    return value;
  }
};

}  // namespace

void check_image_size(const std::string& path, std::size_t place, std::uint64_t width,
                      std::uint64_t height) {
  if (width <= k_image_side_max && height <= k_image_side_max && width * height <= k_pixels_max)
    return;
  throw InputError(path + ":byte " + std::to_string(place) + ": " + std::to_string(width) + " x " +
                   std::to_string(height) + " pixels; expected at most " +
                   std::to_string(k_image_side_max) + " a side and " +
                   std::to_string(k_pixels_max) + " in all");
}

Image read_pgm(const std::string& path, const PgmLimits& limits) {
  return pgm_of(read_file(path, k_pgm_bytes_max, "a binary PGM image"), path, limits);
}

Image pgm_of(std::string_view bytes, const std::string& path, const PgmLimits& limits) {
  if (bytes.compare(0, 2, "P5") != 0) {
    throw InputError(path + ":byte 0: does not begin with P5; expected a binary PGM image");
  }
  Reader reader{path, bytes};
  Image out;
  out.width = reader.number("a width", 1, limits.width);
  out.height = reader.number("a height", 1, limits.height);
  check_image_size(path, reader.at, static_cast<std::uint64_t>(out.width),
                   static_cast<std::uint64_t>(out.height));
  const bool deep = limits.bits_min > 8;
  out.bits = reader.number(deep ? "a maxval for 16 bits" : "a maxval", deep ? 256 : 1, 65535) > 255
                 ? 16
                 : 8;
  ++reader.at;  // the single blank before the pixels
  const std::size_t size = out.bits == 16 ? 2 : 1;
  const std::size_t count =
      static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
  const std::size_t found = bytes.size() > reader.at ? bytes.size() - reader.at : 0;
  if (found != size * count) {
    reader.fail(std::to_string(found) + " bytes of pixels", std::to_string(size * count));
  }
  out.values.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint16_t value = 0;
    for (std::size_t k = 0; k < size; ++k) {  // high byte first
      value = static_cast<std::uint16_t>(
          value << 8 | static_cast<std::uint8_t>(bytes[reader.at + size * i + k]));
    }
    out.values[i] = value;
  }
  return out;
}

}  // namespace glint
