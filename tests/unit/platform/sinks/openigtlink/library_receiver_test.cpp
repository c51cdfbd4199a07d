// What OpenIGTLink's own library receives from the sink.
#include <gtest/gtest.h>
#include <igtlClientSocket.h>
#include <igtlMessageHeader.h>
#include <igtlStatusMessage.h>
#include <igtlTrackingDataMessage.h>
#include <igtlTransformMessage.h>
#include <igtl_util.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "platform/sinks/openigtlink/openigtlink_sink.hpp"

namespace glint {
namespace {

constexpr Duration k_tick = milliseconds(4);
constexpr Duration k_clock_start{1'700'000'000'000'000'000};

OpenIgtLinkOptions options_of(std::vector<std::string> tools) {
  OpenIgtLinkOptions options;
  options.server.port = 0;
  options.tool_names = std::move(tools);
  options.unix_minus_session = k_clock_start;
  options.actuation_delay = milliseconds(8);
  return options;
}

PoseSample sample_at(std::uint32_t number, std::uint8_t tool = 0) {
  PoseSample sample;
  sample.tick = Time{} + k_tick * number;
  sample.tick_number = number;
  sample.tool = tool;
  sample.state = TrackState::measured;
  sample.reason = Reason::none;
  sample.pose.translation = Vector3(0.1, -0.25, 0.5 + 0.001 * number);
  sample.pose.rotation = Quaternion(0.8, 0.0, 0.6, 0.0);
  return sample;
}

class Receiver {
 public:
  explicit Receiver(int port) : socket_(igtl::ClientSocket::New()) {
    connected_ = socket_->ConnectToServer("127.0.0.1", port) == 0;
    socket_->SetReceiveTimeout(10'000);
  }
  ~Receiver() { socket_->CloseSocket(); }
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  // Receives a header; returns the type's name, "" at the end of the stream.
  std::string next() {
    header_ = igtl::MessageHeader::New();
    header_->InitPack();
    if (socket_->Receive(header_->GetPackPointer(), header_->GetPackSize()) !=
        header_->GetPackSize()) {
      return "";
    }
    header_->Unpack();
    return header_->GetDeviceType();
  }
  // Receives the body of the header; null if the checksum is wrong.
  template <class Message>
  typename Message::Pointer body() {
    typename Message::Pointer message = Message::New();
    message->SetMessageHeader(header_);
    message->AllocatePack();
    socket_->Receive(message->GetPackBodyPointer(), message->GetPackBodySize());
    if ((message->Unpack(1) & igtl::MessageHeader::UNPACK_BODY) == 0) return nullptr;
    return message;
  }
  [[nodiscard]] bool connected() const { return connected_; }
  [[nodiscard]] std::string device() const { return header_->GetDeviceName(); }
  [[nodiscard]] Time time() const {
    unsigned int seconds = 0, fraction = 0;
    header_->GetTimeStamp(&seconds, &fraction);
    return Time{std::int64_t{seconds} * 1'000'000'000 + igtl_frac_to_nanosec(fraction)};
  }

 private:
  igtl::ClientSocket::Pointer socket_;
  igtl::MessageHeader::Pointer header_;
  bool connected_ = false;
};

void wait_for_client(const OpenIgtLinkSink& sink, std::uint64_t clients) {
  for (int i = 0; i < 5000 && sink.counts().clients < clients; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ASSERT_EQ(sink.counts().clients, clients);
}

void expect_pose(igtl::Matrix4x4& found, const Pose& pose) {
  const Matrix3 rotation = pose.rotation.toRotationMatrix();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      EXPECT_NEAR(found[row][column], rotation(row, column), 1e-6) << row << column;
    }
    EXPECT_NEAR(found[row][3], 1000 * pose.translation[row], 1e-4) << row;
  }
}

TEST(OpenIgtLink, LibraryReceivesPosesAndTheirTimes) {
  OpenIgtLinkSink sink(options_of({"pen"}));
  sink.start();
  Receiver receiver(sink.port());
  ASSERT_TRUE(receiver.connected());
  wait_for_client(sink, 1);
  const std::uint32_t ticks = 100;
  for (std::uint32_t tick = 0; tick < ticks; ++tick) EXPECT_TRUE(sink.offer(sample_at(tick)));
  sink.stop();
  std::uint32_t transforms = 0, trackings = 0;
  std::vector<int> codes;
  for (std::string type = receiver.next(); !type.empty(); type = receiver.next()) {
    if (type == "STATUS") {
      const auto status = receiver.body<igtl::StatusMessage>();
      ASSERT_TRUE(status.IsNotNull());
      EXPECT_EQ(receiver.device(), "pen");
      codes.push_back(status->GetCode());
      if (codes.size() > 1) continue;
      EXPECT_STREQ(status->GetErrorName(), "measured");
      EXPECT_STREQ(status->GetStatusString(), "none");
      continue;
    }
    igtl::Matrix4x4 found;
    std::uint32_t tick = 0;
    if (type == "TRANSFORM") {
      const auto transform = receiver.body<igtl::TransformMessage>();
      ASSERT_TRUE(transform.IsNotNull());
      transform->GetMatrix(found);
      EXPECT_EQ(receiver.device(), "pen");
      tick = 5 * transforms++;  // one each 20 ms
    } else {
      ASSERT_EQ(type, "TDATA");
      const auto tracking = receiver.body<igtl::TrackingDataMessage>();
      ASSERT_TRUE(tracking.IsNotNull());
      ASSERT_EQ(tracking->GetNumberOfTrackingDataElements(), 1);
      igtl::TrackingDataElement::Pointer element;
      tracking->GetTrackingDataElement(0, element);
      EXPECT_STREQ(element->GetName(), "pen");
      EXPECT_EQ(element->GetType(), igtl::TrackingDataElement::TYPE_6D);
      element->GetMatrix(found);
      EXPECT_EQ(receiver.device(), "Glint");
      tick = 5 * trackings++;
    }
    const PoseSample sample = sample_at(tick);
    expect_pose(found, sample.pose);
    const Time expected = sample.tick + k_clock_start + milliseconds(8);
    EXPECT_LE(std::abs((receiver.time() - expected).nanoseconds), 32)
        << "the library's conversion adds up to 32 roundings";
  }
  EXPECT_EQ(transforms, ticks / 5);
  EXPECT_EQ(trackings, ticks / 5);
  EXPECT_EQ(codes, (std::vector<int>{1, 19}));
  const OpenIgtLinkCounts counts = sink.counts();
  EXPECT_EQ(counts.offered, ticks);
  EXPECT_EQ(counts.sent, transforms + trackings + codes.size());
  EXPECT_EQ(counts.lost(), 0u);
}

TEST(OpenIgtLink, LibraryReceivesEveryToolAndEachChangeOfState) {
  OpenIgtLinkSink sink(options_of({"pen", "spare"}));
  sink.start();
  Receiver receiver(sink.port());
  wait_for_client(sink, 1);
  sink.offer(sample_at(0, 0));
  sink.offer(sample_at(0, 1));
  PoseSample lost = sample_at(10, 1);
  lost.state = TrackState::lost;
  lost.reason = Reason::too_old;
  sink.offer(sample_at(10, 0));
  sink.offer(lost);
  sink.stop();
  std::vector<int> elements;
  std::vector<std::string> states;
  for (std::string type = receiver.next(); !type.empty(); type = receiver.next()) {
    if (type == "TDATA") {
      elements.push_back(
          receiver.body<igtl::TrackingDataMessage>()->GetNumberOfTrackingDataElements());
    } else if (type == "STATUS") {
      const auto status = receiver.body<igtl::StatusMessage>();
      states.push_back(receiver.device() + " " + std::to_string(status->GetCode()) + " " +
                       status->GetErrorName() + " " + status->GetStatusString());
    } else {
      (void)receiver.body<igtl::TransformMessage>();
    }
  }
  EXPECT_EQ(elements, (std::vector<int>{2, 1}));
  EXPECT_EQ(states, (std::vector<std::string>{
                        "pen 1 measured none", "spare 1 measured none", "spare 13 lost too_old",
                        "pen 19 shutdown the run ends", "spare 19 shutdown the run ends"}));
}

}  // namespace
}  // namespace glint
