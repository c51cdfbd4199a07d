#include "platform/sensors/pgm.hpp"

#include <fstream>
#include <iterator>

#include "kernels/limits.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

struct Reader {
  const std::string& path;
  const std::string& bytes;
  std::size_t at = 2;  // behind "P5"

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

Pgm read_pgm_16(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be opened; expected a 16-bit PGM picture");
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (bytes.compare(0, 2, "P5") != 0) {
    throw InputError(path + ":byte 0: does not begin with P5; expected a binary PGM picture");
  }
  Reader reader{path, bytes};
  Pgm out;
  out.width = reader.number("a width", 1, k_width_max);
  out.height = reader.number("a height", 1, k_height_max);
  reader.number("a maxval for 16 bits", 256, 65535);
  ++reader.at;  // the single blank before the pixels
  const std::size_t count =
      static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
  const std::size_t found = bytes.size() > reader.at ? bytes.size() - reader.at : 0;
  if (found != 2 * count) {
    reader.fail(std::to_string(found) + " bytes of pixels", std::to_string(2 * count));
  }
  out.pixels.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto high = static_cast<std::uint8_t>(bytes[reader.at + 2 * i]);
    const auto low = static_cast<std::uint8_t>(bytes[reader.at + 2 * i + 1]);
    out.pixels[i] = static_cast<std::uint16_t>(high << 8 | low);
  }
  return out;
}

}  // namespace glint
