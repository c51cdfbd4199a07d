// The frames of a recording of hl2ss (version 23): depth AHAT without compression, or long throw.
//
// Layout: "HL2SSV23", u16 port, u32 length and as many bytes of the user's, the configuration that
// was sent to the device, then packets as on the wire. Little endian. Source: hl2ss 9a70fad.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "platform/record/input_file.hpp"
#include "platform/sources/frame_reader.hpp"
#include "platform/sources/planes.hpp"

namespace glint {

class Hl2ssFrames final : public FrameReader {
 public:
  // `source.calibration`: of the same device, as its server sends it; without it there is no head
  // pose, which the recording has of the rig alone. Throws InputError: another file or version,
  // another stream, or one that was compressed.
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
  std::uint64_t at_ = 0;  // of the next packet
  std::uint64_t empty_ = 0, unreadable_ = 0;
  std::string first_unreadable_, missing_;
  Bytes packet_;
};

}  // namespace glint
