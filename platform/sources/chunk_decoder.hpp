// Decompresses chunks of MCAP files written by other programs: zstd and LZ4 frames.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace glint {

// Implements ChunkDecoder (platform/sinks/record/mcap_reader.hpp). Returns false unless `to` is
// filled exactly.
[[nodiscard]] bool decode_chunk(std::string_view compression, std::span<const std::uint8_t> from,
                                std::span<std::uint8_t> to);

}  // namespace glint
