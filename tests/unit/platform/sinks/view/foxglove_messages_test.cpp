#include "platform/sinks/view/foxglove_messages.hpp"

#include <gtest/gtest.h>

#include "platform/input_error.hpp"
#include "platform/sinks/view/foxglove_server.hpp"

namespace glint {
namespace {

TEST(FoxgloveRequest, NamesChannelsAndSubscriptions) {
  const auto begin = request_of(
      R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":2},{"id":4294967295,"channelId":0}]})");
  ASSERT_TRUE(begin.has_value());
  ASSERT_EQ(begin->begun.size(), 2u);
  EXPECT_EQ(begin->begun[0].id, 7u);
  EXPECT_EQ(begin->begun[0].channel, 2u);
  EXPECT_EQ(begin->begun[1].id, 4294967295u);
  EXPECT_TRUE(begin->ended.empty());
  const auto end = request_of(R"({"op":"unsubscribe","subscriptionIds":[7,9]})");
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->ended, (std::vector<std::uint32_t>{7, 9}));
  EXPECT_TRUE(end->begun.empty());
}

TEST(FoxgloveRequest, IsNothingElse) {
  std::string many = R"({"op":"unsubscribe","subscriptionIds":[0)";
  for (std::size_t i = 0; i < k_subscriptions_max; ++i) many += ",0";
  for (const std::string& text :
       {std::string(""), std::string("{"), std::string("[]"), std::string("7"), std::string("{}"),
        std::string(R"({"op":"advertise","channels":[]})"), std::string(R"({"op":"subscribe"})"),
        std::string(R"({"op":"subscribe","subscriptions":{}})"),
        std::string(R"({"op":"subscribe","subscriptions":[3]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":1}]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":1}]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":1.5,"channelId":1}]})"),
        std::string(R"({"op":"unsubscribe","subscriptionIds":[-1]})"), many + "]}"}) {
    EXPECT_FALSE(request_of(text).has_value()) << text.substr(0, 80);
  }
}

TEST(FoxgloveMessage, BeginsWithOperationSubscriptionAndTime) {
  EXPECT_EQ(message_head(0x04030201, 0x0C0B0A0908070605),
            (std::vector<std::uint8_t>{1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
}

TEST(FoxgloveServer, RefusesABusyPortAndAForeignAddress) {
  const FoxgloveServer first({"127.0.0.1", 0});
  EXPECT_GT(first.port(), 0);
  EXPECT_THROW(FoxgloveServer({"127.0.0.1", first.port()}), MissingDevice);
  EXPECT_THROW(FoxgloveServer({"192.0.2.1", 0}), MissingDevice);  // an address for documentation
}

TEST(FoxgloveServer, StoresNothingThatNobodySubscribesTo) {
  FoxgloveServer server({"127.0.0.1", 0});
  server.add_channel(1, "/glint/depth", "sensor_msgs/msg/Image", "uint8[] data");
  const std::vector<std::uint8_t> image(1 << 20);
  for (std::uint64_t i = 0; i < 100; ++i) server.add_message(1, i, image);
  server.add_message(2, 0, image);  // of no channel
  server.close();
  server.add_message(1, 0, image);
  EXPECT_EQ(server.counts().messages, 0u);
  EXPECT_EQ(server.counts().dropped, 0u);
}

}  // namespace
}  // namespace glint
