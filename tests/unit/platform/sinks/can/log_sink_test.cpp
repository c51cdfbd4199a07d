#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <csignal>

#include "platform/sinks/can/can_sink.hpp"
#include "platform/sinks/can/candump_line.hpp"
#include "tests/unit/platform/sinks/can/temporary_folder.hpp"
#include "tests/unit/text_of.hpp"

namespace glint::log_sink_test {
namespace {

CanFrame frame_number(std::uint32_t number) {
  CanFrame frame;
  frame.identifier = number & 0x7FFU;
  frame.length = 4;
  for (std::size_t i = 0; i < 4; ++i) frame.data[i] = static_cast<std::uint8_t>(number >> 8 * i);
  return frame;
}

CanSinkOptions options_in(const std::filesystem::path& folder) {
  CanSinkOptions options;
  options.directory = folder;
  options.unix_offset_ns = 1'700'000'000'000'000'000;
  options.when_full = OverflowPolicy::wait;
  return options;
}

TEST(LogSink, WritesEveryFrameInOrderWithItsTime) {
  constexpr std::int64_t k_step_ns = 1'000'000;
  constexpr std::uint32_t k_count = 40000;  // more than the ring holds
  const TemporaryFolder folder;
  {
    const auto sink = open_can_sink("log:can.log", options_in(folder.path()));
    for (std::uint32_t i = 0; i < k_count; ++i) sink->send(frame_number(i), Time{i * k_step_ns});
    sink->flush();
    EXPECT_EQ(sink->counts().sent, k_count);
    EXPECT_TRUE(sink->counts().all_sent());
  }
  std::ifstream log(folder.path() / "can.log");
  std::string line;
  std::uint32_t read = 0;
  for (; std::getline(log, line); ++read) {
    const auto record = parse_candump(line);
    ASSERT_TRUE(record) << line;
    ASSERT_EQ(record->unix_ns, 1'700'000'000'000'000'000 + read * k_step_ns);
    ASSERT_EQ(record->frame.data, frame_number(read).data);
  }
  EXPECT_EQ(read, k_count);
}

TEST(LogSink, GivesTheFileItsNameOnlyWhenItIsComplete) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "can.log";
  {
    const auto sink = open_can_sink("log:can.log", options_in(folder.path()));
    sink->send(frame_number(1), {});
    sink->flush();
    EXPECT_FALSE(std::filesystem::exists(file));
    EXPECT_EQ(text_of(folder.path() / "can.log.part"), "(1700000000.000000) can0 001#01000000\n");
  }
  EXPECT_EQ(text_of(file), "(1700000000.000000) can0 001#01000000\n");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "can.log.part"));
}

TEST(LogSink, CountsWhatADeviceRefuses) {
  const auto sink = open_can_sink("log:/dev/full", options_in("/"));
  for (std::uint32_t i = 0; i < 100; ++i) sink->send(frame_number(i), {});
  sink->flush();
  EXPECT_EQ(sink->counts().failed, 100U);
  EXPECT_EQ(sink->counts().sent, 0U);
  EXPECT_EQ(sink->counts().error, ENOSPC);
  sink->send(frame_number(0), {});
  sink->flush();
  EXPECT_EQ(sink->counts().failed, 101U);
}

// The disk is full after some bytes: the log ends with its last complete line.
TEST(LogSink, EndsAtAWholeLineWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  CanSinkCounts counts;
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 1000;
  {
    const auto sink = open_can_sink("log:can.log", options_in(folder.path()));
    for (std::uint32_t i = 0; i < 10; ++i) sink->send(frame_number(i), {});
    sink->flush();
    setrlimit(RLIMIT_FSIZE, &small);
    for (std::uint32_t i = 0; i < 100; ++i) sink->send(frame_number(i), {});
    sink->flush();
    for (std::uint32_t i = 0; i < 100; ++i) sink->send(frame_number(i), {});
    sink->flush();
    counts = sink->counts();
    setrlimit(RLIMIT_FSIZE, &before);
  }
  const std::string text = text_of(folder.path() / "can.log");
  const auto lines = static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '\n'));
  EXPECT_EQ(lines, 26U);  // of 38 bytes
  EXPECT_TRUE(text.ends_with("00F#0F000000\n"));
  EXPECT_EQ(counts.sent, lines);
  EXPECT_EQ(counts.failed, 210 - lines);
  EXPECT_EQ(counts.dropped, 0U);
  EXPECT_EQ(counts.error, EFBIG);
}

}  // namespace
}  // namespace glint::log_sink_test
