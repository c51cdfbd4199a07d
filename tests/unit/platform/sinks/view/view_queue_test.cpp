#include "platform/sinks/view/view_queue.hpp"

#include <gtest/gtest.h>

namespace glint {
namespace {

std::vector<std::uint8_t> payload(std::size_t bytes, std::uint8_t value) {
  return std::vector<std::uint8_t>(bytes, value);
}

// A client of a queue of 100 kB with a small channel 1 and a large channel 2.
class ViewQueueTest : public testing::Test {
 protected:
  ViewQueueTest() {
    queue_.add_channel(1, "/glint/button", "glint_msgs/msg/Button", "bool pressed");
    queue_.add_channel(2, "/glint/depth", "sensor_msgs/msg/Image", "uint8[] data");
    queue_.enter(client_);
    (void)texts();
  }

  // Sends all that waits; returns the texts, and stores the messages' first bytes.
  std::vector<std::string> texts() {
    std::vector<std::string> found;
    values_.clear();
    do {
      for (; !client_.waiting.empty(); client_.waiting.pop_front()) {
        const Outgoing& out = client_.waiting.front();
        if (out.message == nullptr) {
          found.emplace_back(out.head.begin(), out.head.end());
        } else {
          values_.push_back(out.message->cdr.at(0));
        }
      }
      queue_.enqueue_next(client_);
    } while (!client_.waiting.empty());
    return found;
  }

  std::vector<int> values() {
    (void)texts();
    return values_;
  }

  ViewQueue queue_{100'000};
  ViewClient client_;
  std::vector<int> values_;
};

TEST_F(ViewQueueTest, AdvertisesEachChannelOnceAndLaterOnesAgain) {
  ViewClient late;
  queue_.enter(late);
  late.waiting.clear();
  queue_.enqueue_next(late);
  ASSERT_EQ(late.waiting.size(), 1u);
  const auto& head = late.waiting[0].head;
  const std::string text(head.begin(), head.end());
  EXPECT_NE(text.find("/glint/button"), std::string::npos);
  EXPECT_NE(text.find("/glint/depth"), std::string::npos);
  EXPECT_TRUE(texts().empty());
  queue_.add_channel(3, "/tf", "tf2_msgs/msg/TFMessage", "");
  const std::vector<std::string> added = texts();
  ASSERT_EQ(added.size(), 1u);
  EXPECT_NE(added[0].find("/tf"), std::string::npos);
  EXPECT_EQ(added[0].find("/glint/depth"), std::string::npos);
}

TEST_F(ViewQueueTest, SendsWhatIsSubscribedToInOrderAndNothingElse) {
  queue_.apply(client_, R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":2}]})");
  EXPECT_FALSE(queue_.add_message(1, 10, payload(9, 1)));
  EXPECT_TRUE(queue_.add_message(2, 11, payload(9, 2)));
  EXPECT_TRUE(queue_.add_message(2, 12, payload(9, 3)));
  EXPECT_FALSE(queue_.add_message(7, 13, payload(9, 4)));
  EXPECT_EQ(values(), (std::vector<int>{2, 3}));
  queue_.apply(client_, R"({"op":"unsubscribe","subscriptionIds":[5]})");
  EXPECT_FALSE(queue_.add_message(2, 14, payload(9, 5)));
  EXPECT_TRUE(values().empty());
  EXPECT_EQ(queue_.counts().messages, 2u);
  EXPECT_EQ(queue_.counts().dropped, 0u);
}

TEST_F(ViewQueueTest, StartsALateClientWithTheNewestSmallMessage) {
  (void)queue_.add_message(1, 10, payload(9, 1));
  (void)queue_.add_message(1, 11, payload(9, 2));
  (void)queue_.add_message(2, 12, payload(k_newest_bytes_max + 1, 3));
  queue_.apply(
      client_,
      R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":1},{"id":1,"channelId":2}]})");
  EXPECT_EQ(values(), (std::vector<int>{2}));
  // One that the queue still holds is sent once.
  (void)queue_.add_message(1, 13, payload(9, 4));
  queue_.apply(client_, R"({"op":"subscribe","subscriptions":[{"id":2,"channelId":1}]})");
  EXPECT_EQ(values(), (std::vector<int>{4, 4}));  // of both subscriptions
}

TEST_F(ViewQueueTest, CountsWhatASlowClientLoses) {
  queue_.apply(client_, R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":2}]})");
  for (std::uint8_t i = 1; i <= 10; ++i) (void)queue_.add_message(2, i, payload(30'000, i));
  EXPECT_EQ(values(), (std::vector<int>{8, 9, 10}));
  EXPECT_EQ(queue_.counts().dropped, 7u);
  for (std::uint8_t i = 1; i <= 5; ++i) (void)queue_.add_message(2, i, payload(30'000, i));
  EXPECT_FALSE(queue_.is_at_end(client_));
  queue_.leave(client_);  // two more left the queue before its turn
  EXPECT_EQ(queue_.counts().dropped, 9u);
  EXPECT_FALSE(queue_.add_message(2, 6, payload(9, 6)));
}

TEST_F(ViewQueueTest, AnswersRequestsThatItCannotFulfil) {
  for (const char* request :
       {"nonsense", R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3}]})"}) {
    queue_.apply(client_, request);
    const std::vector<std::string> answers = texts();
    ASSERT_EQ(answers.size(), 1u) << request;
    EXPECT_NE(answers[0].find("\"status\""), std::string::npos);
  }
  queue_.apply(
      client_,
      R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":1},{"id":0,"channelId":2}]})");
  EXPECT_EQ(texts().size(), 1u);  // the second one has the first one's number
  EXPECT_EQ(queue_.counts().invalid, 3u);
  EXPECT_EQ(client_.subscriptions.size(), 1u);
}

}  // namespace
}  // namespace glint
