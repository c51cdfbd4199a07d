// Wire format of hl2ss (version 23), of its server and of its recordings. Little endian.
//
// Packet: u64 stamp in 100 ns, u32 size, payload, and with a pose 16 floats: T_world_rig for row
// vectors. AHAT's payload: u32 size of z, u32 size of ab, both blobs, u64 sensor ticks; raw: z is
// empty, ab holds a plane of depth and a plane of active brightness. Source: hl2ss 9a70fad.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "kernels/geometry.hpp"
#include "platform/formats/camera.hpp"

namespace glint {

inline constexpr std::uint16_t k_hl2ss_port_ahat = 3804, k_hl2ss_port_long_throw = 3805;
inline constexpr std::uint8_t k_hl2ss_profile_raw = 255, k_hl2ss_profile_z_same = 0;
inline constexpr std::size_t k_hl2ss_heading_bytes = 12, k_hl2ss_pose_bytes = 64;
inline constexpr std::size_t k_hl2ss_sensor_ticks_bytes = 8;

struct Hl2ssHeading {
  std::uint64_t stamp = 0;  // QPC or FILETIME, 100 ns
  std::uint32_t payload_bytes = 0;
};
[[nodiscard]] Hl2ssHeading hl2ss_heading(
    std::span<const std::uint8_t, k_hl2ss_heading_bytes> bytes) noexcept;

// Bytes of the payload of a raw AHAT frame with that number of pixels.
[[nodiscard]] constexpr std::size_t hl2ss_ahat_bytes(std::size_t pixels) {
  return 8 + 4 * pixels + k_hl2ss_sensor_ticks_bytes;
}

enum class AhatContents : std::uint8_t { frame, empty, wrong_size };  // empty: the server had none
struct AhatPayload {
  AhatContents contents = AhatContents::wrong_size;
  std::uint32_t z_bytes = 0, ab_bytes = 0;            // as stated
  std::span<const std::uint8_t> depth, reflectivity;  // planes of u16; empty unless a frame
};
[[nodiscard]] AhatPayload hl2ss_ahat(std::span<const std::uint8_t> payload,
                                     std::size_t pixels) noexcept;

// Returns the transform of a matrix for row vectors; empty if it is not rigid. hl2ss marks an
// invalid pose by a last element of 0.
[[nodiscard]] std::optional<Pose> hl2ss_pose(
    std::span<const std::uint8_t, k_hl2ss_pose_bytes> bytes) noexcept;

// Returns T_rig_camera of a device's calibration, which holds rig to camera. Throws InputError with
// `name`: another size than the camera's, or no rigid transform. alias: of AHAT, not of long throw.
[[nodiscard]] Pose hl2ss_rig_camera(std::span<const std::uint8_t> calibration, const Camera& camera,
                                    bool alias, const std::string& name);

}  // namespace glint
