// OpenIGTLink messages, protocol version 1: TRANSFORM, TDATA and STATUS as bytes.
//
// A header of 58 bytes (version, type, device, time stamp, size and CRC-64 of the body) and a body;
// all numbers are big-endian, lengths in millimetres (OpenIGTLink protocol specification, version
// 1).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "kernels/geometry.hpp"
#include "kernels/limits.hpp"
#include "kernels/units.hpp"

namespace glint {

inline constexpr std::size_t k_openigtlink_header_bytes = 58;
inline constexpr std::size_t k_openigtlink_tool_bytes = 70;  // of a tool in TDATA
inline constexpr std::size_t k_openigtlink_name_bytes = 20;  // the last one is zero

struct OpenIgtLinkTool {
  std::string_view name;
  Pose pose;
};

enum class OpenIgtLinkStatus : std::uint16_t { ok = 1, not_ready = 13, shutdown = 19 };

class OpenIgtLinkMessage {
 public:
  // `unix_time`: for which the contents hold. Names are cut to 19 characters.
  [[nodiscard]] static OpenIgtLinkMessage transform(std::string_view device, Time unix_time,
                                                    const Pose& pose) noexcept;
  // At most k_tools_max tools.
  [[nodiscard]] static OpenIgtLinkMessage tracking(std::string_view device, Time unix_time,
                                                   std::span<const OpenIgtLinkTool> tools) noexcept;
  // `name`: of the state; `text`: for a person, cut to 64 characters.
  [[nodiscard]] static OpenIgtLinkMessage status(std::string_view device, Time unix_time,
                                                 OpenIgtLinkStatus code, std::string_view name,
                                                 std::string_view text) noexcept;

  [[nodiscard]] std::span<const std::uint8_t> bytes() const noexcept {
    return std::span(bytes_).first(size_);
  }

 private:
  void add_number(std::uint64_t value, std::size_t bytes) noexcept;
  void add_name(std::string_view text, std::size_t bytes) noexcept;
  void add_matrix(const Pose& pose) noexcept;
  // Writes the header for the body.
  void finish(std::string_view type, std::string_view device, Time unix_time) noexcept;

  static constexpr std::size_t k_bytes_max =
      k_openigtlink_header_bytes + k_tools_max * k_openigtlink_tool_bytes;
  std::array<std::uint8_t, k_bytes_max> bytes_{};
  std::size_t size_ = k_openigtlink_header_bytes;
};

}  // namespace glint
