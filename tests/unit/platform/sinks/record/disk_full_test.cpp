// Real full disk: a tmpfs of one megabyte if the test may mount one, otherwise a file size limit.
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>
#include <string>
#include <thread>

#include "platform/input_error.hpp"
#include "platform/sinks/record/growing_file.hpp"
#include "platform/sinks/record/recorder.hpp"
#include "platform/sinks/record/recording_reader.hpp"
#include "platform/sinks/record/trajectory_files.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

namespace glint {
namespace {

RecorderSettings small_chunks() {
  RecorderSettings settings;
  settings.file.chunk_bytes = std::size_t{64} << 10;
  settings.when_full = OverflowPolicy::wait;
  return settings;
}

// Records several megabytes. The part that the disk accepts must be a valid recording.
void record_past_the_end(const std::string& path) {
  constexpr std::uint64_t k_frames = 100;  // 49 kB each
  RecordingOutcome outcome;
  std::uint64_t lost_while_recording = 0;
  {
    Recorder recorder(path, sample_info(RecordingLevel::full), small_chunks());
    const FrameBuffer buffer = sample_frame(128, 96, 16);
    for (std::uint64_t i = 1; i <= k_frames; ++i) {
      recorder.frame_lane().offer_choice(sample_choice(i));
      EXPECT_TRUE(recorder.frame_lane().offer_frame(buffer.view({1}, {2}, 3), {}));
    }
    while (recorder.lost() == 0) std::this_thread::yield();
    lost_while_recording = recorder.lost();
    outcome = recorder.close();
  }
  EXPECT_TRUE(outcome.ended_early);
  EXPECT_FALSE(outcome.complete());
  EXPECT_EQ(outcome.dropped, 0U);
  EXPECT_GT(outcome.messages, 10U);
  EXPECT_LT(outcome.messages, 4 * k_frames);
  EXPECT_EQ(outcome.messages + outcome.lost, 4 * k_frames) << "each is written or counted";
  EXPECT_GE(outcome.lost, lost_while_recording);
  EXPECT_GT(lost_while_recording, 0U);
  EXPECT_GT(outcome.bytes, 500'000U);
  EXPECT_NE(outcome.reason.find(path), std::string::npos) << outcome.reason;
  EXPECT_TRUE(std::filesystem::exists(path)) << outcome.reason;

  EXPECT_THROW(RecordingReader reader(path), InputError);
  RecordingReader reader(path, {.truncated = false, .incomplete = true});
  std::uint64_t choices = 0, frames = 0;
  while (const auto message = reader.next()) {
    if (const auto* choice = std::get_if<ChoiceRecord>(&*message)) {
      EXPECT_EQ(choice->activation, ++choices);
    }
    if (std::holds_alternative<FrameMessage>(*message)) ++frames;
  }
  EXPECT_GT(frames, 5U);
  EXPECT_NE(reader.facts().at("ended_early"), "");
}

class SmallDisk {
 public:
  explicit SmallDisk(std::string path) : path_(std::move(path)) {
    std::filesystem::create_directory(path_);
    mounted_ = ::mount("tmpfs", path_.c_str(), "tmpfs", 0, "size=1m") == 0;
  }
  ~SmallDisk() {
    if (mounted_) ::umount2(path_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  [[nodiscard]] bool mounted() const { return mounted_; }

 private:
  std::string path_;
  bool mounted_;
};

TEST(DiskFull, EndsTheRecordingWithItsLastWholeChunk) {
  const TemporaryFolder folder;
  const SmallDisk disk(folder.file("disk"));
  if (!disk.mounted()) GTEST_SKIP() << "may not mount a tmpfs here";
  record_past_the_end(folder.file("disk/run.mcap"));
}

// Runs `check` in a child process with a file size limit of 1 MB: the limit applies to the process.
template <class Check>
void with_file_limit(Check check) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1'000'000, 1'000'000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    check();
    ::_exit(testing::Test::HasFailure() ? 1 : 0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

TEST(DiskFull, LimitOnTheSizeOfFilesEndsTheRecordingLikewise) {
  const TemporaryFolder folder;
  with_file_limit([&] { record_past_the_end(folder.file("run.mcap")); });
}

TEST(DiskFull, CountsTheLinesThatATrajectoryLacks) {
  const TemporaryFolder folder;
  const std::string path = folder.file("samples.csv");
  with_file_limit([&] {
    constexpr std::uint64_t k_samples = 10'000;
    CsvFile csv(path);
    PoseSample sample;
    for (std::uint64_t i = 0; i < k_samples; ++i) csv.write(sample);
    EXPECT_GT(csv.file().lines_lost(), 0U);
    EXPECT_FALSE(csv.close());
    std::ifstream file(path);
    std::uint64_t lines = 0;
    for (std::string line; std::getline(file, line);) ++lines;
    EXPECT_GT(lines, 1'000U);
    EXPECT_EQ(lines + csv.file().lines_lost(), k_samples + 1) << "with the heading";
  });
}

TEST(DiskFull, LeavesNothingOfWhatDidNotFitWhole) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a");
  with_file_limit([&] {
    GrowingFile file(path);
    const std::vector<std::uint8_t> small(10, 1), large(600'000, 2);
    EXPECT_TRUE(file.append({small, large}));
    EXPECT_FALSE(file.append({small, large}));
    EXPECT_EQ(file.size(), 600'010U);
    EXPECT_EQ(std::filesystem::file_size(path + ".part"), 600'010U);
    EXPECT_NE(file.error().find("write at byte 600010"), std::string::npos) << file.error();
    EXPECT_TRUE(file.append({small}));
    EXPECT_TRUE(file.finish());
    EXPECT_EQ(std::filesystem::file_size(path), 600'020U);
  });
}

}  // namespace
}  // namespace glint
