#include "platform/sinks/dds/reader_process.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <string>
#include <thread>

#include "platform/input_error.hpp"
#include "platform/sinks/dds/dds_sink.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"

namespace glint {
namespace {

constexpr Duration k_limit = milliseconds(20'000);

class ReaderProcesses : public DdsTest {
 protected:
  ~ReaderProcesses() override { std::remove(file_.c_str()); }
  std::string file_ = testing::TempDir() + "glint_dds_reader_" + std::to_string(getpid()) + ".json";
};

// Offers samples at the sink's pace, so that the ring never overflows.
void offer_paced(DdsSink& sink, std::uint32_t first, std::uint32_t count) {
  for (std::uint32_t i = first; i < first + count; ++i) {
    sink.offer(i % 10 == 0 ? lost_sample_at(i) : sample_at(i));
    const auto waiting = [&] {
      const DdsCounts now = sink.counts();
      return now.offered > now.written + now.ring_dropped + 50;
    };
    while (waiting()) {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }
}

// Fewer samples than the sink keeps for retransmission: a reliable reader receives all of them.
TEST_F(ReaderProcesses, ReceiveAllThatTheSinkKeeps) {
  DdsSink sink(test_settings());
  ReaderProcess reader(test_settings(), file_);
  ASSERT_TRUE(sink.wait_for_readers(1, k_limit));
  sink.start();
  offer_paced(sink, 7, 90);
  sink.stop();
  EXPECT_EQ(sink.counts().written, 90u);
  EXPECT_EQ(sink.counts().poses_written, 81u);
  const ReaderResult result = reader.finish(k_limit);
  EXPECT_EQ(result.received, 90u);
  EXPECT_EQ(result.missed, 0u);
  EXPECT_EQ(result.poses_expected, 81u);
  EXPECT_LE(result.poses_received, 81u);
  EXPECT_EQ(result.first_tick, 7u);
  EXPECT_EQ(result.last_tick, 96u);
  EXPECT_EQ(result.streams_ended, 1u);
}

TEST_F(ReaderProcesses, CountEverySampleOfEveryToolReceivedOrMissed) {
  DdsSettings settings = test_settings();
  settings.tool_names = {"pen", "pointer"};
  DdsSink sink(settings);
  ReaderProcess reader(settings, file_);
  ASSERT_TRUE(sink.wait_for_readers(1, k_limit));
  sink.start();
  offer_paced(sink, 0, 2000);
  for (std::uint32_t i = 0; i < 40; ++i) sink.offer(sample_at(i, 1));
  sink.stop();
  EXPECT_EQ(sink.counts().offered, 2040u);
  EXPECT_EQ(sink.counts().written + sink.counts().ring_dropped, 2040u);
  const ReaderResult result = reader.finish(k_limit);
  EXPECT_GE(result.received, 40u);
  EXPECT_EQ(result.received + result.missed, sink.counts().written);
  EXPECT_EQ(result.streams_ended, 2u);
}

// A process of its own that polls would take a core from the run it observes.
TEST_F(ReaderProcesses, TakeNoProcessorTimeWhileNothingArrives) {
  DdsSettings settings = test_settings();
  settings.tool_names = {"pen", "pointer"};
  const auto cpu_s = [] {
    rusage used{};
    getrusage(RUSAGE_CHILDREN, &used);
    return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  };
  const double before = cpu_s();
  {
    DdsSink sink(settings);
    ReaderProcess reader(settings, file_);
    ASSERT_TRUE(sink.wait_for_readers(1, k_limit));
    sink.start();
    offer_paced(sink, 0, 1);
    std::this_thread::sleep_for(std::chrono::seconds(2));
    sink.stop();
    EXPECT_EQ(reader.finish(k_limit).received, 1u);
  }
  EXPECT_LT(cpu_s() - before, 1) << "of the 2 s without a message";
}

TEST_F(ReaderProcesses, CountNoLossWhereTheRingDropped) {
  DdsSink sink(test_settings());
  ReaderProcess reader(test_settings(), file_);
  ASSERT_TRUE(sink.wait_for_readers(1, k_limit));
  constexpr std::uint32_t too_many = DdsSink::k_ring_capacity + 500;
  for (std::uint32_t i = 0; i < too_many; ++i) sink.offer(sample_at(i));
  sink.start();
  while (sink.counts().written < DdsSink::k_ring_capacity) std::this_thread::yield();
  offer_paced(sink, too_many, 100);
  sink.stop();
  EXPECT_EQ(sink.counts().ring_dropped, 500u);
  const ReaderResult result = reader.finish(k_limit);
  EXPECT_EQ(result.received + result.missed, sink.counts().written);
}

TEST_F(ReaderProcesses, CountWhatWasWrittenBeforeTheyCame) {
  DdsSink sink(test_settings());
  sink.start();
  offer_paced(sink, 0, 300);
  while (sink.counts().written < 300) std::this_thread::yield();
  ReaderProcess reader(test_settings(), file_);
  ASSERT_TRUE(sink.wait_for_readers(1, k_limit));
  offer_paced(sink, 300, 200);
  sink.stop();
  const ReaderResult result = reader.finish(k_limit);
  EXPECT_GE(result.missed, 300u);
  EXPECT_EQ(result.received + result.missed, 500u);
}

// The reader is stopped while more samples are written than the sink and the socket can hold.
TEST_F(ReaderProcesses, CountWhatWasLostOnTheWay) {
  DdsSink sink(test_settings());
  ReaderProcess reader(test_settings(), file_);
  ASSERT_TRUE(sink.wait_for_readers(1, k_limit));
  sink.start();
  offer_paced(sink, 0, 100);
  kill(reader.id(), SIGSTOP);
  offer_paced(sink, 100, 20'000);
  kill(reader.id(), SIGCONT);
  offer_paced(sink, 20'100, 100);
  sink.stop();
  const ReaderResult result = reader.finish(k_limit);
  EXPECT_GT(result.missed, 0u);
  EXPECT_EQ(sink.counts().written, 20'200u);
  EXPECT_EQ(result.received + result.missed, sink.counts().written);
}

TEST_F(ReaderProcesses, FailWhereTheInterfaceIsMissing) {
  DdsSettings settings = test_settings();
  settings.interface = "nowhere0";
  ReaderProcess reader(settings, file_);
  EXPECT_THROW((void)reader.finish(k_limit), MissingDevice);
}

TEST_F(ReaderProcesses, EndWhenToldTo) {
  ReaderProcess reader(test_settings(), file_);
  const ReaderResult result = reader.finish(Duration{});
  EXPECT_EQ(result.received, 0u);
  EXPECT_EQ(result.streams_ended, 0u);
}

}  // namespace
}  // namespace glint
