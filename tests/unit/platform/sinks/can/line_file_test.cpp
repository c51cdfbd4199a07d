// Line file on a disk that accepts all, some or none of its lines.
#include "platform/sinks/can/line_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include "platform/descriptor.hpp"
#include "platform/sinks/can/can_sink.hpp"
#include "tests/unit/platform/sinks/can/temporary_folder.hpp"
#include "tests/unit/text_of.hpp"

namespace glint::line_file_test {
namespace {

// While it lives, no file of this process grows beyond the limit.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit small = before_;
    small.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FileLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;

 private:
  rlimit before_{};
};

// Ten lines of ten bytes in two pieces, on a disk with `room` bytes free.
TEST(LineFile, KeepsTheWholeLinesForWhichThereIsRoom) {
  for (rlim_t room = 1; room <= 100; ++room) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "lines";
    {
      LineFile file(path);
      EXPECT_EQ(file.lines_lost(), 0u);
      const FileLimit limit(room);
      for (int i = 0; i < 5; ++i) file.add("123456789\n");
      file.write_out();
      for (int i = 0; i < 5; ++i) file.add("123456789\n");
      file.write_out();
      EXPECT_EQ(file.lines_lost(), 10 - room / 10) << room;
      EXPECT_EQ(file.error(), room == 100 ? 0 : EFBIG) << room;
    }
    EXPECT_EQ(std::filesystem::file_size(path), room / 10 * 10) << room;
  }
}

TEST(LineFile, CountsEachLineOnceTheDiskHasRefused) {
  const TemporaryFolder folder;
  LineFile file(folder.path() / "lines");
  const FileLimit limit(1);
  file.add("one\n");
  EXPECT_EQ(file.lines_lost(), 0u) << "nothing is written before write_out()";
  file.write_out();
  EXPECT_EQ(file.lines_lost(), 1u);
  file.add("two\n");
  file.add("three\n");
  EXPECT_EQ(file.lines_lost(), 3u);
  file.write_out();
  EXPECT_EQ(file.lines_lost(), 3u);
}

TEST(LineFile, WritesIntoADeviceAndRefusesOneThatIsFull) {
  LineFile file("/dev/full");
  file.add("one\n");
  file.add("two\n");
  file.write_out();
  EXPECT_EQ(file.lines_lost(), 2u);
  EXPECT_EQ(file.error(), ENOSPC);
  EXPECT_FALSE(std::filesystem::exists("/dev/full.part"));
}

TEST(LineFile, LeavesNoDescriptorOpen) {
  const auto open_files = [] {
    const std::filesystem::directory_iterator files("/proc/self/fd");
    return std::distance(begin(files), end(files));
  };
  const TemporaryFolder folder;
  const auto before = open_files();
  { const LineFile file(folder.path() / "lines"); }
  {
    Descriptor first(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    const Descriptor second(std::move(first));
    EXPECT_EQ(open_files(), before + 1);
  }
  EXPECT_EQ(open_files(), before);
}

// The pipe's reader does not read: exactly the frames beyond the capacity are dropped and counted.
TEST(LogSink, DropsWhatItsQueueHasNoRoomForAndWritesAllTheRest) {
  const TemporaryFolder folder;
  const auto pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const Descriptor reader(::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  ASSERT_EQ(::fcntl(reader.get(), F_SETFL, 0), 0);  // from now on a read blocks
  std::uint64_t refused = 0, lines = 0;
  std::thread reading;
  {
    CanSinkOptions options;
    options.directory = folder.path();
    const auto sink = open_can_sink("log:pipe", options);
    for (int i = 0; i < 40'000; ++i) refused += sink->send({}, {}) ? 0 : 1;
    EXPECT_EQ(sink->counts().dropped, refused);
    EXPECT_GT(refused, 0u);
    reading = std::thread([&] {
      std::array<char, 65536> text;
      for (ssize_t got = 1; got > 0;) {
        got = ::read(reader.get(), text.data(), text.size());
        lines += static_cast<std::uint64_t>(
            std::count(text.begin(), text.begin() + std::max<ssize_t>(got, 0), '\n'));
      }
    });
    sink->flush();
    const CanSinkCounts counts = sink->counts();
    EXPECT_EQ(counts.sent, 40'000 - refused);
    EXPECT_EQ(counts.dropped, refused);
    EXPECT_EQ(counts.failed, 0u);
    EXPECT_EQ(counts.error, 0);
  }
  reading.join();
  EXPECT_EQ(lines, 40'000 - refused);
}

}  // namespace
}  // namespace glint::line_file_test
