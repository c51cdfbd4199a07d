// Reader of frames from a capture of HoloLens2ForCV's StreamRecorder (Microsoft, 2072055): a folder
// with `Depth AHaT.tar` or `Depth Long Throw.tar`, or the unpacked folder of that name.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "platform/sinks/record/input_file.hpp"
#include "platform/sources/frame_reader.hpp"

namespace glint {

class StreamRecorderFrames final : public FrameReader {
 public:
  // Throws InputError: no capture of a depth camera, or none of the size of `camera`.
  StreamRecorderFrames(const std::string& folder, const Camera& camera);

  [[nodiscard]] bool next(ReadFrame& frame) override;
  [[nodiscard]] std::optional<SourceLens> lens() const override;  // of <sensor>_lut.bin
  [[nodiscard]] std::uint64_t unreadable() const override { return unreadable_; }
  [[nodiscard]] std::string first_unreadable() const override { return first_unreadable_; }
  [[nodiscard]] ReaderCounts counts() const override;
  [[nodiscard]] std::string missing() const override { return missing_; }
  [[nodiscard]] std::string text() const override;
  [[nodiscard]] std::optional<Duration> unix_offset() const override;

 private:
  struct File {
    std::string name;  // in the archive or folder; empty: none
    std::uint64_t offset = 0, bytes = 0;
  };
  struct Pair {
    File depth, reflectivity;
  };
  void list_archive();
  void list_folder();
  void add(const std::string& name, std::uint64_t offset, std::uint64_t bytes);
  void read_poses();
  void read_frame(std::uint64_t stamp, const Pair& pair, ReadFrame& frame);
  [[nodiscard]] std::string contents_of(const File& file) const;

  std::string prefix_;  // path of the sensor's files, up to its name
  Camera camera_;
  std::unique_ptr<InputFile> archive_;   // null: a folder
  std::map<std::uint64_t, Pair> pairs_;  // by stamp, 100 ns
  std::map<std::uint64_t, Pair>::const_iterator next_;
  std::map<std::uint64_t, Pose> T_world_camera_;
  std::uint64_t poses_refused_ = 0, unreadable_ = 0;
  std::string first_unreadable_, missing_, no_pose_;
};

}  // namespace glint
