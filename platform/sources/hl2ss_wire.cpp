#include "platform/sources/hl2ss_wire.hpp"

#include <cstring>

#include "platform/input_error.hpp"
#include "platform/sinks/record/bytes.hpp"
#include "platform/sources/matrix_pose.hpp"

namespace glint {

Hl2ssHeading hl2ss_heading(std::span<const std::uint8_t, k_hl2ss_heading_bytes> bytes) noexcept {
  ByteReader reader(bytes);
  Hl2ssHeading heading;
  heading.stamp = reader.number<std::uint64_t>();
  heading.payload_bytes = reader.number<std::uint32_t>();
  return heading;
}

AhatPayload hl2ss_ahat(std::span<const std::uint8_t> payload, std::size_t pixels) noexcept {
  ByteReader reader(payload);
  AhatPayload found;
  found.z_bytes = reader.number<std::uint32_t>();
  found.ab_bytes = reader.number<std::uint32_t>();
  if (reader.failed()) return found;
  const std::size_t plane_bytes = 2 * pixels;
  if (found.ab_bytes == 0) {
    found.contents = AhatContents::empty;
  } else if (payload.size() == hl2ss_ahat_bytes(pixels) && found.z_bytes == 0 &&
             found.ab_bytes == 2 * plane_bytes) {
    found.contents = AhatContents::frame;
    found.depth = reader.take(plane_bytes);
    found.reflectivity = reader.take(plane_bytes);
  }
  return found;
}

std::optional<Pose> hl2ss_pose(std::span<const std::uint8_t, k_hl2ss_pose_bytes> bytes) noexcept {
  std::array<float, 16> floats;
  std::memcpy(floats.data(), bytes.data(), sizeof floats);
  MatrixNumbers numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = double{floats[i]};
  return pose_of_matrix(transposed(numbers));
}

Pose hl2ss_rig_camera(std::span<const std::uint8_t> calibration, const Camera& camera, bool alias,
                      const std::string& name) {
  const std::size_t expected = hl2ss_calibration_bytes(camera.model, alias);
  if (calibration.size() != expected) {
    throw InputError(name + ": " + std::to_string(calibration.size()) + " bytes; expected " +
                     std::to_string(expected) + ", the size for " + camera.name);
  }
  const std::size_t at = 8 * static_cast<std::size_t>(camera.model.width) *
                         static_cast<std::size_t>(camera.model.height);
  const std::optional<Pose> T_camera_rig =
      hl2ss_pose(calibration.subspan(at).first<k_hl2ss_pose_bytes>());
  if (!T_camera_rig) {
    throw InputError(name + ":byte " + std::to_string(at) +
                     ": not a rigid transform; expected rig to camera, for row vectors");
  }
  return T_camera_rig->inverse();
}

}  // namespace glint
