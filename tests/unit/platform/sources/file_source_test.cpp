#include "platform/sources/file_source.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "platform/input_error.hpp"
#include "platform/runtime/session/simulated_run.hpp"
#include "platform/sim/simulator.hpp"
#include "platform/sources/open_source.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"

namespace glint {
namespace {

Camera small_camera() {
  Camera camera = hololens2_ahat();
  camera.model.width = 2;
  camera.model.height = 1;
  return camera;
}

ReadFrame frame_at(std::int64_t ms) {
  ReadFrame frame;
  frame.pixels = {2, 1, {}, {1, 2}, {3, 4}};
  frame.mid_exposure = Time{} + milliseconds(ms);
  frame.head.valid = true;
  return frame;
}

class Frames final : public FrameReader {
 public:
  explicit Frames(std::vector<ReadFrame> frames) : frames_(std::move(frames)) {}
  bool next(ReadFrame& frame) override {
    if (at_ == frames_.size()) {
      if (!fault.empty()) throw InputError(fault);
      return false;
    }
    frame = frames_[at_++];
    return true;
  }
  std::string text() const override { return "frames"; }
  std::optional<Duration> unix_offset() const override { return Duration{5}; }

  std::string fault;

 private:
  std::vector<ReadFrame> frames_;
  std::size_t at_ = 0;
};

struct Delivered {
  std::vector<ArrivedFrame> frames;  // without their pixels
  SourceReport report;
  [[nodiscard]] std::uint64_t count(const std::string& name) const {
    for (const auto& [count_name, count] : report.counts) {
      if (count_name == name) return count;
    }
    ADD_FAILURE() << "no count " << name;
    return 0;
  }
};

Delivered delivered_by(FrameSource& source) {
  Delivered delivered;
  source.start({});
  ArrivedFrame arrived;
  while (source.wait(arrived)) {
    EXPECT_EQ(arrived.frame.reflectivity_16.pixels[1], 2);
    delivered.frames.push_back(arrived);
    source.release_pixels(arrived);
  }
  EXPECT_FALSE(source.wait(arrived));
  delivered.report = source.report();
  return delivered;
}

Delivered delivered_of(std::vector<ReadFrame> frames) {
  FileSource source(std::make_unique<Frames>(std::move(frames)), small_camera());
  return delivered_by(source);
}

std::string refusal_of(const ReadFrame& first) {
  try {
    FileSource source(std::make_unique<Frames>(std::vector{first}), small_camera());
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

// More frames than slots.
TEST(FileSource, DeliversFramesInSessionTime) {
  std::vector<ReadFrame> frames;
  for (int i = 0; i < 100; ++i) frames.push_back(frame_at(1'700'000'000'000 + 25 * i));
  const Delivered delivered = delivered_of(frames);
  ASSERT_EQ(delivered.frames.size(), 100u);
  const Camera camera = small_camera();
  EXPECT_EQ(delivered.frames[0].frame.arrival, Time{} + camera.period);
  for (std::size_t i = 0; i < 100; ++i) {
    const Frame& frame = delivered.frames[i].frame;
    EXPECT_EQ(frame.sequence, i);
    EXPECT_EQ(frame.mid_exposure - delivered.frames[0].frame.mid_exposure,
              milliseconds(25 * static_cast<std::int64_t>(i)));
    EXPECT_EQ(frame.arrival - frame.mid_exposure,
              camera.transport + Duration{camera.exposure.nanoseconds / 2});
    EXPECT_EQ(delivered.frames[i].head.time, frame.mid_exposure);
  }
  EXPECT_TRUE(delivered.report.failures.empty());
}

TEST(FileSource, LeavesAloneStampsThatAreTheSessions) {
  FileSource source(std::make_unique<Frames>(std::vector{frame_at(70), frame_at(90)}),
                    small_camera());
  EXPECT_EQ(source.unix_offset(), Duration{5});
  EXPECT_EQ(delivered_by(source).frames[1].frame.mid_exposure, Time{} + milliseconds(90));
}

// Otherwise a run would tick from 0 to that time.
TEST(FileSource, BeginsTheSessionAtAStampThatCannotBeItsOwn) {
  for (const std::int64_t ms : {-5LL, 1001LL, 1'700'000'000'000LL}) {
    FileSource source(std::make_unique<Frames>(std::vector{frame_at(ms)}), small_camera());
    const Duration unix_offset = *source.unix_offset();
    const Frame frame = delivered_by(source).frames.at(0).frame;
    EXPECT_EQ(frame.arrival, Time{} + small_camera().period);
    EXPECT_EQ(frame.mid_exposure + unix_offset, Time{} + milliseconds(ms) + Duration{5});
  }
}

TEST(FileSource, SkipsAndCountsStampsByKind) {
  const Delivered delivered =
      delivered_of({frame_at(0), frame_at(20), frame_at(20), frame_at(10), frame_at(40),
                    frame_at(4'000'000'000), frame_at(12'060)});
  EXPECT_EQ(delivered.frames.size(), 4u);
  EXPECT_EQ(delivered.count("stamps_doubled"), 1u);
  EXPECT_EQ(delivered.count("stamps_backward"), 1u);
  EXPECT_EQ(delivered.count("stamps_far_off"), 1u);
  EXPECT_EQ(delivered.count("gaps_over_1_s"), 1u);
  EXPECT_EQ(delivered.count("longest_gap_ms"), 12'020u);
  EXPECT_TRUE(delivered.report.failures.empty());
}

TEST(FileSource, TakesAStatedArrivalOnlyWhereItCanBe) {
  std::vector<ReadFrame> frames;
  const std::int64_t after_ms[] = {3, -1, 20'000, 30};
  for (int i = 0; i < 4; ++i) {
    frames.push_back(frame_at(20 * i));
    frames.back().arrival = frames.back().mid_exposure + milliseconds(after_ms[i]);
  }
  const Delivered delivered = delivered_of(frames);
  const Duration declared = small_camera().transport + milliseconds(1);
  const Duration expected[] = {milliseconds(3), declared, declared, milliseconds(30)};
  for (std::size_t i = 0; i < 4; ++i) {
    const Frame& frame = delivered.frames[i].frame;
    EXPECT_EQ(frame.arrival - frame.mid_exposure, expected[i]) << i;
  }
}

TEST(FileSource, DeliversArrivalsInOrder) {
  std::vector<ReadFrame> frames{frame_at(0), frame_at(20)};
  frames[0].arrival = frames[0].mid_exposure + milliseconds(90);
  const Delivered delivered = delivered_of(frames);
  EXPECT_EQ(delivered.frames[1].frame.arrival, delivered.frames[0].frame.arrival);
}

TEST(FileSource, RefusesHeadPosesThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<ReadFrame> frames;
  for (int i = 0; i < 6; ++i) frames.push_back(frame_at(20 * i));
  frames[1].head.T_world_camera.translation.y() = nan;
  frames[2].head.T_world_camera.rotation.w() = nan;
  frames[3].head.T_world_camera.rotation = Quaternion(0, 0, 0, 0);
  frames[4].head.T_world_camera.translation.x() = 1e9;
  frames[5].head.valid = false;
  const Delivered delivered = delivered_of(frames);
  ASSERT_EQ(delivered.frames.size(), 6u);
  EXPECT_TRUE(delivered.frames[0].head.valid);
  for (std::size_t i = 1; i < 6; ++i) EXPECT_FALSE(delivered.frames[i].head.valid) << i;
  EXPECT_EQ(delivered.count("head_poses_refused"), 4u);
  EXPECT_EQ(delivered.count("frames_without_head_pose"), 1u);
}

TEST(FileSource, ScalesAPrintedRotationToUnitLength) {
  ReadFrame frame = frame_at(0);
  frame.head.T_world_camera.rotation = Quaternion(0.7071, 0.7071, 0, 0);
  const Delivered delivered = delivered_of({frame});
  EXPECT_NEAR(delivered.frames[0].head.T_world_camera.rotation.norm(), 1, 1e-15);
}

TEST(FileSource, RefusesAFirstFrameOfAnotherCamera) {
  ReadFrame frame = frame_at(0);
  frame.pixels.depth.clear();
  EXPECT_NE(refusal_of(frame).find("no depth; expected 2 x 1 pixels with 16 bits"),
            std::string::npos)
      << refusal_of(frame);
  frame = frame_at(0);
  frame.pixels.reflectivity_16.clear();
  EXPECT_NE(refusal_of(frame).find("no reflectivity"), std::string::npos);
  frame.pixels.reflectivity_8 = {1, 2};
  EXPECT_NE(refusal_of(frame).find("another number of bits"), std::string::npos);
  frame = frame_at(0);
  frame.pixels.height = 2;
  EXPECT_NE(refusal_of(frame).find("2 x 2 pixels"), std::string::npos);
  EXPECT_EQ(refusal_of(frame_at(0)), "none");
}

TEST(FileSource, CountsLaterFramesOfAnotherCameraAsLost) {
  ReadFrame other = frame_at(20);
  other.pixels.width = 1;
  const Delivered delivered = delivered_of({frame_at(0), other, frame_at(40)});
  EXPECT_EQ(delivered.frames.size(), 2u);
  EXPECT_EQ(delivered.count("frames_unreadable"), 1u);
  ASSERT_EQ(delivered.report.failures.size(), 1u);
  EXPECT_NE(delivered.report.failures[0].find("1 x 1 pixels"), std::string::npos);
}

TEST(FileSource, ReportsWhatEndedTheReading) {
  auto reader = std::make_unique<Frames>(std::vector{frame_at(0)});
  reader->fault = "byte 7: cut";
  FileSource source(std::move(reader), small_camera());
  const Delivered delivered = delivered_by(source);
  EXPECT_EQ(delivered.frames.size(), 1u);
  ASSERT_EQ(delivered.report.failures.size(), 1u);
  EXPECT_EQ(delivered.report.failures[0], "reading stopped early: byte 7: cut");
}

// The duration limits the arrival time, 9 ms after the middle of the exposure.
TEST(FileSource, LeavesOutWhatArrivesAfterTheDuration) {
  std::vector<ReadFrame> frames;
  for (int i = 0; i < 100; ++i) frames.push_back(frame_at(20 * i));
  FileSource source(std::make_unique<Frames>(frames), small_camera(), milliseconds(1000));
  const Delivered delivered = delivered_by(source);
  EXPECT_EQ(delivered.frames.size(), 50u);
  EXPECT_TRUE(delivered.report.failures.empty());
}

TEST(FileSource, RefusesAFileWithoutAFrame) {
  EXPECT_THROW(FileSource(std::make_unique<Frames>(std::vector<ReadFrame>{}), small_camera()),
               InputError);
}

TEST(OpenSource, NamesTheKindsThereAre) {
  Cell cell = default_cell();
  cell.source.kind = "kinect";
  cell.source.path = "x";
  cell.source.position = "cell.toml:3: source";
  try {
    (void)open_source(cell);
    FAIL();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("cell.toml:3: source.kind: \"kinect\"; expected simulator, "))
        << message;
    for (const char* kind : {" dds,", " hl2ss,", " shm,", " folder,", " hl2ss_file,", " recording,",
                             " rosbag,", " stream_recorder"}) {
      EXPECT_TRUE(message.find(kind) != std::string::npos) << message << ": no" << kind;
    }
  }
  cell.source.kind = "folder";
  cell.source.path = "";
  EXPECT_THROW((void)open_source(cell), InputError);
}

std::string big_endian(const std::vector<std::uint16_t>& values) {
  std::string bytes;
  for (const std::uint16_t value : values) {
    bytes += static_cast<char>(value >> 8);
    bytes += static_cast<char>(value & 0xFF);
  }
  return bytes;
}

// Lossless text: 17 digits a number.
void write_folder(const Cell& cell, const std::string& folder) {
  const sim::Simulator simulator(scenario_of(cell));
  std::ofstream csv(folder + "/frames.csv");
  csv.precision(17);
  csv << "time_ns,arrival_ns,sequence,reflectivity,depth,x_m,y_m,z_m,qx,qy,qz,qw\n";
  sim::SimFrame frame;
  for (int i = 0; i < simulator.frame_count(); ++i) {
    simulator.render(i, frame);
    const Frame view = frame.view();
    const std::string name = std::to_string(i);
    for (const auto& [ending, values] : {std::pair{"_ab.pgm", &frame.pixels.reflectivity_16},
                                         std::pair{".pgm", &frame.pixels.depth}}) {
      std::ofstream(folder + "/" + name + ending, std::ios::binary) << "P5 512 512 65535\n"
                                                                    << big_endian(*values);
    }
    csv << view.mid_exposure.nanoseconds << ',' << view.arrival.nanoseconds << ',' << view.sequence
        << ',' << name << "_ab.pgm," << name << ".pgm";
    const Pose& pose = frame.head.T_world_camera;
    for (int axis = 0; axis < 3; ++axis) csv << ',' << pose.translation[axis];
    for (int part = 0; part < 4; ++part) csv << ',' << pose.rotation.coeffs()[part];
    csv << '\n';
  }
}

SessionResult tracked(Cell cell, const std::string& kind, const std::string& path,
                      const std::string& out) {
  cell.source.kind = kind;
  cell.source.path = path;
  const auto source = open_source(cell);
  SessionOptions options;
  options.out = out;
  return run_source(cell, source.get(), options);
}

TEST(RecordedRun, OfARecordingGivesTheRunsOutputRecords) {
  for (const char* level : {"full", "roi"}) {
    const TemporaryFolder first, again;
    const Cell cell = short_cell(1.5, level);
    const SessionResult run = short_run(cell, first.path());
    const SessionResult result = tracked(cell, "recording", run.recording_file, again.path());
    EXPECT_EQ(result.output_sha256, run.output_sha256) << level;
    EXPECT_EQ(result.frames, run.frames);
    EXPECT_EQ(result.frames_tracked, run.frames_tracked);
    EXPECT_EQ(result.source.text.find("pixels inside ROIs only") != std::string::npos,
              level == std::string("roi"));
  }
}

TEST(RecordedRun, OfAFolderGivesTheRunsOutputRecords) {
  const TemporaryFolder run_out, frames, again;
  const Cell cell = short_cell(1);
  const SessionResult run = short_run(cell, run_out.path());
  write_folder(cell, frames.path());
  const SessionResult result = tracked(cell, "folder", frames.path(), again.path());
  EXPECT_EQ(result.frames, run.frames);
  EXPECT_EQ(result.frames_tracked, run.frames_tracked);
  EXPECT_GT(run.frames_tracked, 0);
  EXPECT_EQ(result.output_sha256, run.output_sha256);
}

TEST(RecordedRun, RefusesARecordingWithoutFrames) {
  const TemporaryFolder first, again;
  const Cell cell = short_cell(0.3, "blobs");
  const SessionResult run = short_run(cell, first.path());
  EXPECT_THROW((void)tracked(cell, "recording", run.recording_file, again.path()), InputError);
}

}  // namespace
}  // namespace glint
