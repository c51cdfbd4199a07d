// Faults of the DDS process: it is restarted, every lost message is counted, and what it returns is
// not trusted.
#include "platform/sinks/dds/dds_process.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <memory>
#include <random>
#include <thread>

#include "platform/runtime/rt/futex.hpp"
#include "platform/sinks/dds/dds_inputs.hpp"
#include "platform/sinks/dds/dds_sink.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"

namespace glint::dds_process_test {
namespace {

using TheDdsProcess = DdsTest;

// A subscriber of the status: another participant, which counts the ticks that it received.
class Subscriber {
 public:
  explicit Subscriber(const DdsSettings& settings)
      : peer_(settings),
        reader_(peer_.reader(status_type(), topics_of("glint", "pen").status, Reliability::reliable,
                             Durability::volatile_data, 10'000)) {}
  [[nodiscard]] bool discovered(const DdsSink& sink) { return peer_.wait_for_discovery(sink); }
  std::uint64_t received() {
    void* sample[1] = {nullptr};
    dds_sample_info_t info;
    while (dds_take(reader_, sample, &info, 1, 1) == 1) {
      if (info.valid_data && !static_cast<const StatusMessage*>(sample[0])->ends_stream) ++count_;
      dds_return_loan(reader_, sample, 1);
    }
    return count_;
  }

 private:
  Peer peer_;
  dds_entity_t reader_;
  std::uint64_t count_ = 0;
};

// Offers a sample each 2 ms until `done`; returns the next tick.
template <class Done>
std::uint32_t offer_until(DdsSink& sink, std::uint32_t tick, Done done) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!done() && std::chrono::steady_clock::now() < deadline) {
    sink.offer(sample_at(tick++));
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return tick;
}

// Ends the process `ends` times by the signal and expects the subscriber to miss what the sink
// counts as lost.
void expect_counted_losses(int signal, std::uint64_t ends) {
  DdsSink sink(test_settings());
  Subscriber subscriber(test_settings());
  ASSERT_TRUE(subscriber.discovered(sink));
  sink.start();
  const std::shared_ptr<DdsProcess> process = sink.process();
  std::uint32_t tick = offer_until(sink, 0, [&] { return subscriber.received() >= 100; });
  for (std::uint64_t end = 1; end <= ends; ++end) {
    const std::uint64_t before = subscriber.received();
    kill(process->id(), signal);
    tick = offer_until(sink, tick, [&] {
      return process->restarts() == end && subscriber.received() > before + 100;
    });
  }
  sink.stop();
  const std::uint64_t received = subscriber.received();
  const DdsCounts counts = sink.counts();
  EXPECT_EQ(counts.process_restarts, ends);
  EXPECT_EQ(counts.offered, tick);
  EXPECT_EQ(counts.offered, counts.written + counts.ring_dropped);
  EXPECT_GT(counts.ring_dropped, 0u);
  EXPECT_GT(counts.poses_and_transforms_lost, 0u);
  // A process that ends between publishing a message and counting it has this one lost.
  EXPECT_GE(received, counts.written);
  EXPECT_LE(received, counts.written + ends);
}

TEST_F(TheDdsProcess, IsRestartedAfterACrashAndItsLossesAreCounted) {
  expect_counted_losses(SIGKILL, 3);
}

TEST_F(TheDdsProcess, IsRestartedAfterAnAssertion) { expect_counted_losses(SIGABRT, 1); }

TEST_F(TheDdsProcess, IsKilledAndRestartedAfterAStall) { expect_counted_losses(SIGSTOP, 1); }

TEST_F(TheDdsProcess, NeverDelaysTheOfferingThreadWhileItIsStopped) {
  DdsSink sink(test_settings());
  sink.start();
  kill(sink.process()->id(), SIGSTOP);
  const std::uint64_t restarts = sink.process()->restarts();
  for (std::uint32_t i = 0; i < 100'000; ++i) sink.offer(sample_at(i));
  // A wait for the process would have lasted until it was killed.
  EXPECT_EQ(sink.process()->restarts(), restarts);
  kill(sink.process()->id(), SIGKILL);
  sink.stop();
  EXPECT_EQ(sink.counts().offered, sink.counts().written + sink.counts().ring_dropped);
}

TEST_F(TheDdsProcess, PublishesTheStaticTransformsAgainAfterARestart) {
  DdsSettings settings = test_settings();
  settings.static_transforms = {{"hmd_world", "robot_base", Pose{}}};
  DdsSink sink(settings);
  sink.start();
  kill(sink.process()->id(), SIGKILL);
  ASSERT_TRUE(wait_until([&] { return sink.process()->restarts() == 1; }));
  Peer peer(settings);
  const dds_entity_t reader = peer.reader(tf_type(), k_tf_static_topic, Reliability::reliable,
                                          Durability::transient_local, 100);
  EXPECT_EQ(take<TfMessage>(reader, 1,
                            [](const TfMessage& message) {
                              ASSERT_EQ(message.transforms._length, 1u);
                              EXPECT_STREQ(message.transforms._buffer[0].child_frame_id,
                                           "robot_base");
                            }),
            1u);
}

TEST_F(TheDdsProcess, ReleasesAHeldButtonWhenItEnds) {
  const auto process = DdsProcess::of(test_settings());
  std::vector<ButtonEvent> events;
  DdsInputs inputs(process, test_settings(),
                   [&](const ButtonEvent& event) { events.push_back(event); });
  Peer peer(test_settings());
  const dds_entity_t writer = peer.writer(bool_type(), "rt/glint/button", Reliability::reliable,
                                          Durability::volatile_data, 64);
  ASSERT_TRUE(wait_until([&] { return has_reader(writer); }));
  const auto events_reach = [&](std::size_t count) {
    return wait_until([&] {
      inputs.read(milliseconds(2));
      return events.size() == count;
    });
  };
  const BoolMessage pressed{true};
  dds_write(writer, &pressed);
  ASSERT_TRUE(events_reach(1));
  kill(process->id(), SIGKILL);
  ASSERT_TRUE(events_reach(2));
  EXPECT_FALSE(events[1].pressed);
  EXPECT_EQ(inputs.counts().released, 1u);
  // The restarted process reads the same topic.
  EXPECT_TRUE(wait_until([&] {
    dds_write(writer, &pressed);
    inputs.read(milliseconds(2));
    return events.size() == 3;
  }));
}

// A process whose memory is overwritten by chance, while samples are published.
TEST_F(TheDdsProcess, MayWriteAnythingIntoTheSharedMemory) {
  DdsSink sink(test_settings());
  const std::shared_ptr<DdsProcess> process = sink.process();
  DdsInputs inputs(process, test_settings(), {});
  inputs.start();
  sink.start();
  std::mt19937 random(1);
  std::uint32_t tick = 0;
  for (std::uint64_t end = 1; end <= 5; ++end) {
    const std::string file = "/proc/" + std::to_string(process->id()) + "/fd/3";
    const int descriptor = open(file.c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_GE(descriptor, 0);
    SharedMemory memory(descriptor);
    kill(process->id(), SIGSTOP);  // only this thread writes
    for (std::uint8_t& byte : memory.incoming().first(64 << 10)) {
      byte = static_cast<std::uint8_t>(random());
    }
    ProcessMemory& state = memory.state();
    state.incoming.written = end == 1 ? std::uint64_t{random()} << 32 : random() % (1 << 20);
    state.outgoing.read = random();
    for (EndpointState& endpoint : state.endpoints) endpoint.published = random();
    ++state.to_program;
    futex_wake(state.to_program, 1, FutexUse::processes);
    tick = offer_until(sink, tick, [&] { return process->restarts() == end && process->id() > 0; });
    ASSERT_EQ(process->restarts(), end);
  }
  sink.stop();
  EXPECT_EQ(sink.counts().offered, sink.counts().written + sink.counts().ring_dropped);
}

TEST_F(TheDdsProcess, EndsWithItsLastUser) {
  auto process = DdsProcess::of(test_settings());
  const pid_t id = process->id();
  EXPECT_EQ(DdsProcess::of(test_settings()), process) << "one process for a domain";
  EXPECT_EQ(kill(id, 0), 0);
  process.reset();
  EXPECT_EQ(kill(id, 0), -1);
}

}  // namespace
}  // namespace glint::dds_process_test
