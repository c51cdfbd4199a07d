#include <spng.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <string_view>

#include "platform/formats/image_file.hpp"
#include "platform/input_error.hpp"
#include "platform/part_file.hpp"
#include "platform/read_file.hpp"

namespace glint {
namespace {

using Context = std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)>;

constexpr std::string_view k_signature = "\x89PNG\r\n\x1A\n";
constexpr std::size_t k_width_at = 16, k_height_at = 20;  // in the first chunk, IHDR
constexpr std::size_t k_chunk_bytes_max = 1 << 20, k_chunks_bytes_max = 16 << 20;  // without pixels
constexpr std::size_t k_png_bytes_max = 256 << 20;
constexpr std::uint64_t k_deflate_ratio_max = 1032;  // zlib's manual, "Maximum Compression Factor"

std::uint32_t big_endian(const char* at) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(at[i]);
  return value;
}

// libspng's output format: grey stays grey, everything else gets four channels.
int format_of(const spng_ihdr& header) {
  if (header.color_type == SPNG_COLOR_TYPE_GRAYSCALE) {
    return header.bit_depth == 16 ? SPNG_FMT_PNG : SPNG_FMT_G8;
  }
  return header.bit_depth == 16 ? SPNG_FMT_RGBA16 : SPNG_FMT_RGBA8;
}

// Converts `bytes` of the decoded image, in native byte order, to the image's channels.
void fill(Image& picture, const std::vector<std::uint8_t>& bytes) {
  const std::size_t stored = picture.channels == 1 ? 1 : 4;
  const std::size_t size = picture.bits == 16 ? 2 : 1;
  const std::size_t pixels = bytes.size() / (stored * size);
  picture.values.reserve(pixels * static_cast<std::size_t>(picture.channels));
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(picture.channels); ++c) {
      const std::uint8_t* at = bytes.data() + (i * stored + c) * size;
      std::uint16_t value = *at;
      if (size == 2) std::memcpy(&value, at, 2);
      picture.values.push_back(value);
    }
  }
}

}  // namespace

Image read_png(const std::string& path, const std::string& expected) {
  return png_of(read_file(path, k_png_bytes_max, expected), path, expected);
}

Image png_of(std::string_view file, const std::string& path, const std::string& expected,
             bool transparency) {
  const auto fail = [&](const std::string& found) {
    throw InputError(path + ": " + found + "; expected " + expected);
  };
  if (file.size() < k_height_at + 4 || !file.starts_with(k_signature)) fail("not an image");
  check_image_size(path, k_width_at, big_endian(file.data() + k_width_at),
                   big_endian(file.data() + k_height_at));

  const Context context(spng_ctx_new(0), spng_ctx_free);
  spng_ihdr header{};
  std::size_t size = 0;
  spng_set_chunk_limits(context.get(), k_chunk_bytes_max, k_chunks_bytes_max);
  spng_set_png_buffer(context.get(), file.data(), file.size());
  int error = spng_get_ihdr(context.get(), &header);
  const int format = format_of(header);
  const bool grey = header.color_type == SPNG_COLOR_TYPE_GRAYSCALE;
  if (error == 0) error = spng_decoded_image_size(context.get(), format, &size);
  if (error != 0) fail(std::string("invalid image: ") + spng_strerror(error));
  // Decoding allocates memory for every pixel: refuse a short file that declares many pixels.
  if (std::uint64_t{header.width} * header.height * header.bit_depth / 8 >
      k_deflate_ratio_max * file.size()) {
    fail(std::to_string(file.size()) + " bytes, too few for " + std::to_string(header.width) +
         " x " + std::to_string(header.height) + " pixels");
  }
  std::vector<std::uint8_t> bytes(size);
  error = spng_decode_image(context.get(), bytes.data(), bytes.size(), format, 0);
  if (error != 0) fail(std::string("incomplete image: ") + spng_strerror(error));
  Image picture{static_cast<int>(header.width),
                static_cast<int>(header.height),
                grey           ? 1
                : transparency ? 4
                               : 3,
                header.bit_depth == 16 ? 16 : 8,
                {}};
  fill(picture, bytes);
  return picture;
}

Image read_image_file(const std::string& path) {
  const std::string expected = "a PNG or PGM image";
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be read; expected " + expected);
  const int first = file.get();
  if (first == 'P') return read_pgm(path);
  return read_png(path, expected);
}

void write_png(const std::string& path, int width, int height, int channels,
               const std::uint8_t* values, const std::string& expected) {
  const Context context(spng_ctx_new(SPNG_CTX_ENCODER), spng_ctx_free);
  spng_ihdr header{};
  header.width = static_cast<std::uint32_t>(width);
  header.height = static_cast<std::uint32_t>(height);
  header.bit_depth = 8;
  header.color_type = channels == 1 ? SPNG_COLOR_TYPE_GRAYSCALE : SPNG_COLOR_TYPE_TRUECOLOR;
  spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
  spng_set_ihdr(context.get(), &header);
  const std::size_t size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                           static_cast<std::size_t>(channels);
  std::size_t length = 0;
  int error = spng_encode_image(context.get(), values, size, SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
  const std::unique_ptr<void, void (*)(void*)> png(
      error == 0 ? spng_get_png_buffer(context.get(), &length, &error) : nullptr, std::free);
  if (error != 0) throw InputError(path + ": cannot be encoded: " + spng_strerror(error));
  const std::string reason =
      write_file_atomically(path, std::string_view(static_cast<const char*>(png.get()), length));
  if (!reason.empty()) {
    throw InputError(path + ": cannot be written: " + reason + "; expected " + expected);
  }
}

}  // namespace glint
