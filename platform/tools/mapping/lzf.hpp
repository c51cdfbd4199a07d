// LZF decompression, for the points of a compressed PCD file.
//
// Source: the format of Marc Lehmann's liblzf 3.6 (lzf_d.c). A control byte below 32 precedes
// control + 1 literals. Of any other control byte, the upper three bits are a length; if it is 7,
// the next byte is added. The lower five bits and the next byte are the distance back. Length + 2
// bytes are copied from there; the copy may overlap its own output.
#pragma once

#include <span>
#include <string_view>

namespace glint {

// Three bytes yield at most 264.
inline constexpr std::size_t k_lzf_growth_max = 88;

// Returns false if the output does not have exactly this size, or a reference precedes its start.
[[nodiscard]] bool unpack_lzf(std::string_view packed, std::span<char> to) noexcept;

}  // namespace glint
