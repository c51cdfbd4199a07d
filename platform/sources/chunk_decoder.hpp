// Chunks of MCAP files that other programs compressed: zstd, and LZ4 frames.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace glint {

// A ChunkDecoder (platform/record/mcap_reader.hpp).
[[nodiscard]] bool decode_chunk(std::string_view compression, std::span<const std::uint8_t> from,
                                std::span<std::uint8_t> to);

}  // namespace glint
