// Limits of the OpenIGTLink server: slow clients, too many clients, a full ring, wrong settings.
#include "platform/sinks/openigtlink/openigtlink_sink.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "platform/input_error.hpp"

namespace glint {
namespace {

OpenIgtLinkOptions free_port_options() {
  OpenIgtLinkOptions options;
  options.server.port = 0;
  options.server.period = Duration{};  // a message of each kind at each tick
  options.tool_names = {"pen"};
  return options;
}

PoseSample numbered_sample(std::uint32_t number) {
  PoseSample sample;
  sample.tick = Time{} + milliseconds(4) * number;
  sample.tick_number = number;
  sample.state = TrackState::measured;
  return sample;
}

Descriptor connected_to(const OpenIgtLinkSink& sink) {
  Descriptor client(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(sink.port()));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(connect(client.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  return client;
}

template <class Done>
bool within_10_s(Done done) {
  for (int i = 0; i < 5000 && !done(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return done();
}

TEST(OpenIgtLinkSink, CountsWhatAClientThatReadsNothingMisses) {
  OpenIgtLinkSink sink(free_port_options());
  sink.start();
  const Descriptor client = connected_to(sink);
  ASSERT_TRUE(within_10_s([&] { return sink.counts().clients == 1; }));
  std::uint32_t tick = 0;
  EXPECT_TRUE(within_10_s([&] {
    for (int i = 0; i < 500; ++i) sink.offer(numbered_sample(tick++));
    return sink.counts().missed > 0;
  }));
  sink.stop();
  const OpenIgtLinkCounts counts = sink.counts();
  EXPECT_GE(counts.sent + counts.missed, counts.messages);
  EXPECT_LE(counts.sent + counts.missed, counts.messages + 1) << "one may be cut at the end";
}

TEST(OpenIgtLinkSink, CountsWhatItsFullRingRejects) {
  OpenIgtLinkSink sink(free_port_options());  // not started: nothing reads the ring
  for (std::uint32_t tick = 0; tick < 1030; ++tick) sink.offer(numbered_sample(tick));
  EXPECT_EQ(sink.counts().offered, 1030u);
  EXPECT_EQ(sink.counts().ring_dropped, 6u);
  EXPECT_EQ(sink.lost(), 6u);
}

TEST(OpenIgtLinkSink, RefusesAFifthClient) {
  OpenIgtLinkSink sink(free_port_options());
  sink.start();
  std::vector<Descriptor> clients;
  for (std::uint64_t i = 1; i <= 4; ++i) {
    clients.push_back(connected_to(sink));
    ASSERT_TRUE(within_10_s([&] { return sink.counts().clients == i; }));
  }
  const Descriptor fifth = connected_to(sink);
  char byte = 0;
  EXPECT_EQ(recv(fifth.get(), &byte, 1, 0), 0) << "closed";
  EXPECT_EQ(sink.counts().refused, 1u);
  clients.pop_back();  // its place is free again
  EXPECT_TRUE(within_10_s([&] {
    const Descriptor next = connected_to(sink);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return sink.counts().clients == 5;
  }));
}

TEST(OpenIgtLinkSink, IgnoresWhatAClientSends) {
  OpenIgtLinkSink sink(free_port_options());
  sink.start();
  const Descriptor client = connected_to(sink);
  ASSERT_TRUE(within_10_s([&] { return sink.counts().clients == 1; }));
  const std::vector<char> noise(100'000, 'x');
  EXPECT_EQ(send(client.get(), noise.data(), noise.size(), 0), static_cast<ssize_t>(noise.size()));
  sink.offer(numbered_sample(0));
  char header[58];
  EXPECT_EQ(recv(client.get(), header, sizeof header, MSG_WAITALL), 58);
  EXPECT_STREQ(header + 2, "STATUS");
}

TEST(OpenIgtLinkSink, NamesWhatIsWrongWithItsSettings) {
  const auto message_of = [](const OpenIgtLinkOptions& options) {
    try {
      OpenIgtLinkSink sink(options);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const OpenIgtLinkSink first(free_port_options());
  OpenIgtLinkOptions options = free_port_options();
  options.server.port = first.port();
  EXPECT_THROW(OpenIgtLinkSink{options}, MissingDevice);
  EXPECT_EQ(message_of(options), "openigtlink: 127.0.0.1:" + std::to_string(first.port()) +
                                     ": Address already in use; expected a free port of this "
                                     "machine");
  options = free_port_options();
  options.server.address = "here";
  EXPECT_THROW(OpenIgtLinkSink{options}, InputError);
  options = free_port_options();
  options.tool_names = {"a_very_long_tool_name_1", "a_very_long_tool_name_2"};
  EXPECT_THROW(OpenIgtLinkSink{options}, InputError);
}

}  // namespace
}  // namespace glint
