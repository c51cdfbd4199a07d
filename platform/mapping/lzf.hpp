// LZF, unpacked: how PCL packs the points of a PCD file.
//
// Source: the format as Marc Lehmann's liblzf 3.6 has it (lzf_d.c). A byte below 32 is followed by
// one more literal than it says. Any other's upper three bits are a length, 7 added to by the byte
// that follows; its lower five and the next byte say how far back; two bytes more than that length
// are copied from there, and the copy may run into what it writes.
#pragma once

#include <span>
#include <string_view>

namespace glint {

// Three bytes make 264 at most.
inline constexpr std::size_t k_lzf_growth_max = 88;

// False: they do not make exactly so many bytes, or refer to what is before the first.
[[nodiscard]] bool unpack_lzf(std::string_view packed, std::span<char> to) noexcept;

}  // namespace glint
