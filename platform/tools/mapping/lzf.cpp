#include "platform/tools/mapping/lzf.hpp"

#include <cstdint>
#include <cstring>

namespace glint {

bool unpack_lzf(std::string_view packed, std::span<char> to) noexcept {
  std::size_t in = 0, out = 0;
  const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(packed[at]); };
  while (in < packed.size()) {
    const std::size_t control = byte(in++);
    if (control < 32) {
      const std::size_t length = control + 1;
      if (length > packed.size() - in || length > to.size() - out) return false;
      std::memcpy(to.data() + out, packed.data() + in, length);
      in += length;
      out += length;
      continue;
    }
    std::size_t length = (control >> 5) + 2;
    const bool longer = control >> 5 == 7;
    if (packed.size() - in < (longer ? 2u : 1u)) return false;
    if (longer) length += byte(in++);
    const std::size_t back = ((control & 31) << 8) + byte(in++) + 1;
    if (back > out || length > to.size() - out) return false;
    for (const std::size_t end = out + length; out < end; ++out) to[out] = to[out - back];
  }
  return out == to.size();
}

}  // namespace glint
