// Reader of hl2ss recordings (version 23): depth AHAT without compression, or long throw.
//
// Layout: "HL2SSV23", u16 port, u32 length and that many bytes of user data, the configuration sent
// to the device, then packets as on the wire. Little endian. Source: hl2ss 9a70fad.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "platform/sinks/record/input_file.hpp"
#include "platform/sources/frame_reader.hpp"
#include "platform/sources/planes.hpp"

namespace glint {

class Hl2ssFrames final : public FrameReader {
 public:
  // `source.calibration`: calibration of the same device, as its server sends it. Without it there
  // is no head pose, since the recording contains only the rig's. Throws InputError: another file
  // or version, another stream, or a compressed one.
  Hl2ssFrames(const SourceSettings& source, const Camera& camera);

  [[nodiscard]] bool next(ReadFrame& frame) override;
  [[nodiscard]] std::optional<SourceLens> lens() const override;
  [[nodiscard]] std::uint64_t unreadable() const override { return unreadable_; }
  [[nodiscard]] std::string first_unreadable() const override { return first_unreadable_; }
  [[nodiscard]] ReaderCounts counts() const override;
  [[nodiscard]] std::string missing() const override { return missing_; }
  [[nodiscard]] std::string text() const override;

 private:
  void read_beginning();
  void read_calibration();
  void read_packet(std::uint64_t at, std::uint32_t bytes, ReadFrame& frame);
  [[nodiscard]] PixelPlane plane_of(const std::uint8_t* from, const char* name) const;
  void put_head_pose(std::uint64_t at, ReadFrame& frame) const;

  SourceSettings source_;
  Camera camera_;
  InputFile file_;
  bool long_throw_ = false;
  bool with_pose_ = false;
  std::optional<Pose> T_rig_camera_;
  std::uint64_t at_ = 0;  // offset of the next packet
  std::uint64_t empty_ = 0, unreadable_ = 0;
  std::string first_unreadable_, missing_;
  Bytes packet_;
};

}  // namespace glint
