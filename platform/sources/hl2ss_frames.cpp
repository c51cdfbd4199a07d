#include "platform/sources/hl2ss_frames.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/read_file.hpp"
#include "platform/sources/file_time.hpp"
#include "platform/sources/hl2ss_long_throw.hpp"
#include "platform/sources/hl2ss_wire.hpp"

namespace glint {
namespace {

constexpr std::string_view k_magic = "HL2SSV23";
constexpr std::uint64_t k_packet_bytes_max = 64 << 20;

}  // namespace

Hl2ssFrames::Hl2ssFrames(const SourceSettings& source, const Camera& camera)
    : source_(source), camera_(camera), file_(source.path) {
  read_beginning();
  if (!source.calibration.empty()) read_calibration();
}

void Hl2ssFrames::read_beginning() {
  constexpr std::uint64_t fixed = k_magic.size() + 6;
  Bytes bytes;
  file_.read(0, std::min<std::uint64_t>(file_.size(), fixed), bytes);
  const std::string magic(bytes.begin(), bytes.begin() + std::min(bytes.size(), k_magic.size()));
  if (magic != k_magic || bytes.size() < fixed) {
    file_.refuse(0, "\"" + printable(magic) + "\"",
                 "a recording of hl2ss that begins with HL2SSV23");
  }
  ByteReader reader(std::span<const std::uint8_t>(bytes).subspan(k_magic.size()));
  const auto port = reader.number<std::uint16_t>();
  at_ = fixed + reader.number<std::uint32_t>();
  long_throw_ = port == k_hl2ss_port_long_throw;
  if (port != k_hl2ss_port_ahat && !long_throw_) {
    file_.refuse(k_magic.size(), "the stream of port " + std::to_string(port),
                 "3804 (depth AHAT) or 3805 (depth long throw)");
  }
  // mode, divisor; AHAT: profiles of z and of ab, level, u32 bit rate, options; otherwise a u32.
  const std::uint64_t configuration = long_throw_ ? 6 : 10;
  const std::uint64_t begin = at_;
  if (begin > file_.size() || file_.size() - begin < configuration) {
    file_.refuse(file_.size(), "the end of the file", "the stream's configuration");
  }
  file_.read(begin, configuration, bytes);
  at_ += configuration;
  if (bytes[0] > 1) {
    file_.refuse(begin, "mode " + std::to_string(bytes[0]), "0 or 1: a stream of frames");
  }
  with_pose_ = bytes[0] == 1;
  if (long_throw_) return;
  if (bytes[2] != k_hl2ss_profile_z_same || bytes[3] != k_hl2ss_profile_raw) {
    file_.refuse(begin + 2,
                 "profiles " + std::to_string(bytes[2]) + " and " + std::to_string(bytes[3]) +
                     ": compressed frames",
                 "0 and 255: raw frames with unquantised depth");
  }
  at_ += std::uint64_t{bytes[9]} * 16;
}

void Hl2ssFrames::read_calibration() {
  const std::string bytes =
      read_file(source_.calibration, k_data_bytes_max, "hl2ss's calibration of the device");
  T_rig_camera_ = hl2ss_rig_camera(bytes_of(bytes), camera_, !long_throw_, source_.calibration);
}

std::optional<SourceLens> Hl2ssFrames::lens() const {
  if (source_.calibration.empty()) return std::nullopt;
  return SourceLens{source_.calibration, *with_ray_table(camera_, source_.calibration).table, {}};
}

bool Hl2ssFrames::next(ReadFrame& frame) {
  while (at_ < file_.size()) {
    const std::uint64_t begin = at_, left = file_.size() - begin;
    const std::uint64_t pose = with_pose_ ? k_hl2ss_pose_bytes : 0;
    std::uint64_t whole = k_hl2ss_heading_bytes;
    std::uint32_t payload = 0;
    if (left >= k_hl2ss_heading_bytes) {
      file_.read(begin, k_hl2ss_heading_bytes, packet_);
      const Hl2ssHeading heading = hl2ss_heading(std::span(packet_).first<k_hl2ss_heading_bytes>());
      frame = ReadFrame{};
      frame.mid_exposure = time_of_file_time(heading.stamp);
      payload = heading.payload_bytes;
      whole += payload + pose;
    }
    if (left < whole || payload > k_packet_bytes_max) {
      missing_ = file_.path() + ":byte " + std::to_string(begin) + ": a truncated packet; " +
                 std::to_string(left) + " bytes not read";
      at_ = file_.size();
      return false;
    }
    at_ = begin + whole;
    try {
      const std::uint64_t empty = empty_;
      read_packet(begin + k_hl2ss_heading_bytes, payload, frame);
      if (empty_ != empty) continue;
      if (with_pose_) put_head_pose(at_ - k_hl2ss_pose_bytes, frame);
      return true;
    } catch (const InputError& error) {
      if (unreadable_++ == 0) first_unreadable_ = error.what();
    }
  }
  return false;
}

PixelPlane Hl2ssFrames::plane_of(const std::uint8_t* from, const char* name) const {
  PixelPlane plane{camera_.model.width, camera_.model.height, {}, file_.path() + ":" + name};
  plane.values.resize(static_cast<std::size_t>(plane.width) *
                      static_cast<std::size_t>(plane.height));
  std::memcpy(plane.values.data(), from, 2 * plane.values.size());
  return plane;
}

void Hl2ssFrames::read_packet(std::uint64_t at, std::uint32_t bytes, ReadFrame& frame) {
  file_.read(at, bytes, packet_);
  const std::size_t plane_bytes = 2 * static_cast<std::size_t>(camera_.model.width) *
                                  static_cast<std::size_t>(camera_.model.height);
  const auto refuse = [&](const std::string& found, const std::string& expected) {
    file_.refuse(at, found, expected + " (" + camera_.name + ")");
  };
  std::vector<std::uint8_t> planes;
  if (!long_throw_) {
    const AhatPayload ahat = hl2ss_ahat(packet_, plane_bytes / 2);
    if (ahat.contents == AhatContents::empty) {
      ++empty_;
      return;
    }
    if (ahat.contents == AhatContents::wrong_size) {
      refuse("a frame of " + std::to_string(ahat.z_bytes) + " and " +
                 std::to_string(ahat.ab_bytes) + " bytes",
             "0 and " + std::to_string(2 * plane_bytes));
    }
    planes.assign(ahat.depth.data(), ahat.depth.data() + 2 * plane_bytes);
  } else {
    if (bytes <= k_hl2ss_sensor_ticks_bytes)
      refuse(std::to_string(bytes) + " bytes", "a PNG image");
    planes = hl2ss_long_throw_planes(
        std::span<const std::uint8_t>(packet_).first(bytes - k_hl2ss_sensor_ticks_bytes), camera_,
        file_.path() + ":byte " + std::to_string(at));
  }
  PixelPlane depth = plane_of(planes.data(), "depth");
  fill_pixels(plane_of(planes.data() + plane_bytes, "ab"), std::move(depth), camera_, frame.pixels);
}

// The file has T_world_rig; the camera's pose also requires the extrinsics.
void Hl2ssFrames::put_head_pose(std::uint64_t at, ReadFrame& frame) const {
  if (!T_rig_camera_) return;
  Bytes bytes;
  file_.read(at, k_hl2ss_pose_bytes, bytes);
  const std::optional<Pose> T_world_rig = hl2ss_pose(std::span(bytes).first<k_hl2ss_pose_bytes>());
  if (!T_world_rig) return;
  frame.head.valid = true;
  frame.head.T_world_camera = *T_world_rig * *T_rig_camera_;
}

ReaderCounts Hl2ssFrames::counts() const { return {{"packets_without_frame", empty_}}; }

std::string Hl2ssFrames::text() const {
  std::string text = "hl2ss_file " + file_.path();
  if (!with_pose_) return text + ": recorded without head pose";
  if (!T_rig_camera_) text += ": no head pose without [source] calibration";
  return text;
}

}  // namespace glint
