// Reader of frames from a folder of image files, listed in frames.csv.
//
// First line: comma-separated column names, in any order. Then one row per frame.
//   time_ns      mid-exposure, ns, integer, of any clock
//   reflectivity PGM (P5), PNG or NPY (u8, u16); 8 bits per pixel or more, as the camera's
//   depth        the same with 16 bits, in the camera's raw unit; NPY of floats: metres
//   arrival_ns   optional: last byte in memory, same clock
//   sequence     optional: the device's frame number
//   x_m y_m z_m qx qy qz qw   optional: T_world_camera at mid-exposure; empty: no head pose
// Paths are relative to the folder. A row that cannot be read is counted and skipped.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "platform/formats/camera.hpp"
#include "platform/sources/frame_reader.hpp"

namespace glint {

class FolderFrames final : public FrameReader {
 public:
  // Throws InputError: no frames.csv, a first line without the three required columns, or with an
  // unknown name.
  FolderFrames(const std::string& folder, const Camera& camera);

  [[nodiscard]] bool next(ReadFrame& frame) override;
  [[nodiscard]] std::string text() const override { return "folder " + folder_; }
  [[nodiscard]] std::uint64_t unreadable() const override { return unreadable_; }
  [[nodiscard]] std::string first_unreadable() const override { return first_unreadable_; }

 private:
  void read_heading(std::string_view line);
  void read_row(std::string_view line, ReadFrame& frame) const;
  void read_planes(const std::string& reflectivity, const std::string& depth,
                   FrameBuffer& pixels) const;

  std::string folder_, file_, text_;
  Camera camera_;
  std::vector<int> column_;  // known column of each field in a row
  std::size_t at_ = 0;       // offset in text_
  int line_ = 0;
  std::uint64_t unreadable_ = 0;
  std::string first_unreadable_;
};

}  // namespace glint
