#include "platform/sources/chunk_decoder.hpp"

#include <lz4frame.h>
#include <zstd.h>

namespace glint {
namespace {

// LZ4F_decompress() documents that each call makes progress or ends.
bool decode_lz4(std::span<const std::uint8_t> from, std::span<std::uint8_t> to) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) return false;
  bool ended = false, moved = true;
  while (!ended && moved) {
    std::size_t out = to.size(), in = from.size();
    const std::size_t hint = LZ4F_decompress(context, to.data(), &out, from.data(), &in, nullptr);
    if (LZ4F_isError(hint)) break;
    moved = in > 0 || out > 0;
    from = from.subspan(in);
    to = to.subspan(out);
    ended = hint == 0;
  }
  LZ4F_freeDecompressionContext(context);
  return ended && to.empty();
}

}  // namespace

bool decode_chunk(std::string_view compression, std::span<const std::uint8_t> from,
                  std::span<std::uint8_t> to) {
  if (compression == "lz4") return decode_lz4(from, to);
  return compression == "zstd" &&
         ZSTD_decompress(to.data(), to.size(), from.data(), from.size()) == to.size();
}

}  // namespace glint
