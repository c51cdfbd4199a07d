// What eProsima's Fast DDS, the default middleware of ROS 2, receives from a run. Its messages are
// decoded by Fast CDR.
#include <fastcdr/Cdr.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <gtest/gtest.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "platform/sinks/dds/dds_sink.hpp"
#include "platform/sinks/dds/topic_types.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"

namespace glint::fast_dds_test {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using Bytes = std::vector<std::uint8_t>;

// Any type: the bytes as they arrive.
class BytesType : public dds::TopicDataType {
 public:
  explicit BytesType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 1U << 16;
    m_isGetKeyDefined = false;
  }
  bool serialize(void* /*data*/, rtps::SerializedPayload_t* /*payload*/) override { return false; }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* /*data*/) override {
    return [] { return 0U; };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void* /*data*/, rtps::InstanceHandle_t* /*handle*/, bool /*md5*/) override {
    return false;
  }
};

class Decoder {
 public:
  explicit Decoder(Bytes& bytes)
      : buffer_(reinterpret_cast<char*>(bytes.data()), bytes.size()),
        cdr_(buffer_, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN, eprosima::fastcdr::Cdr::DDS_CDR) {
    cdr_.read_encapsulation();
  }
  template <class Value>
  Value next() {
    Value value{};
    cdr_ >> value;
    return value;
  }

 private:
  eprosima::fastcdr::FastBuffer buffer_;
  eprosima::fastcdr::Cdr cdr_;
};

class Subscriber : public dds::DomainParticipantListener {
 public:
  Subscriber() {
    dds::DomainParticipantQos qos;
    qos.transport().use_builtin_transports = false;
    const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList = {"127.0.0.1"};
    qos.transport().user_transports.push_back(udp);
    participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(
        0, qos, this, dds::StatusMask::none());
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  }
  ~Subscriber() override {
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  Subscriber(const Subscriber&) = delete;
  Subscriber& operator=(const Subscriber&) = delete;

  dds::DataReader* reader(const TopicType& type, const std::string& topic, bool transient_local) {
    const dds::TypeSupport support(new BytesType(type.descriptor->m_typename));
    support.register_type(participant_);
    dds::DataReaderQos qos;
    qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind =
        transient_local ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
    qos.history().depth = 200;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    return subscriber_->create_datareader(
        participant_->create_topic(topic, support.get_type_name(), dds::TOPIC_QOS_DEFAULT), qos);
  }
  // User data of the writer of a topic, as discovered.
  std::string user_data_of(const std::string& topic) {
    const std::lock_guard lock(mutex_);
    return user_data_[topic];
  }

 private:
  void on_publisher_discovery(dds::DomainParticipant* /*participant*/,
                              rtps::WriterDiscoveryInfo&& info) override {
    const std::lock_guard lock(mutex_);
    const std::vector<std::uint8_t>& data = info.info.m_qos.m_userData.getValue();
    user_data_[info.info.topicName().to_string()] = std::string(data.begin(), data.end());
  }

  std::mutex mutex_;
  std::map<std::string, std::string> user_data_;
  dds::DomainParticipant* participant_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
};

// Adds what has arrived; returns whether there are `count`.
bool take_until(dds::DataReader* reader, std::vector<Bytes>& messages, std::size_t count) {
  return wait_until([&] {
    Bytes bytes;
    dds::SampleInfo info;
    while (reader->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) messages.push_back(bytes);
    }
    return messages.size() >= count;
  });
}

using FastDds = DdsTest;

TEST_F(FastDds, ReceivesEveryMessageAndWhatWasPublishedBefore) {
  DdsSettings settings = test_settings();
  Pose robot;
  robot.translation = Vector3(0.6, 0, -0.4);
  settings.static_transforms = {{"hmd_world", "robot_base", robot}};
  settings.robot_description = "<robot name=\"arm\"></robot>";
  DdsSink sink(settings);
  sink.start();
  Subscriber subscriber;  // later than the two messages that are published once
  dds::DataReader* const pose = subscriber.reader(pose_stamped_type(), "rt/glint/pen_pose", false);
  dds::DataReader* const tf = subscriber.reader(tf_type(), "rt/tf", false);
  dds::DataReader* const statics = subscriber.reader(tf_type(), "rt/tf_static", true);
  dds::DataReader* const text = subscriber.reader(text_type(), "rt/robot_description", true);
  dds::DataReader* const status = subscriber.reader(status_type(), "rt/glint/pen_status", false);
  std::vector<Bytes> statuses, poses, transforms, late_transforms, descriptions;
  ASSERT_TRUE(take_until(statics, late_transforms, 1));
  ASSERT_TRUE(take_until(text, descriptions, 1));
  ASSERT_TRUE(sink.wait_for_readers(1, milliseconds(k_timeout_ms)));
  constexpr std::uint32_t k_ticks = 90;  // less than the status history
  for (std::uint32_t tick = 0; tick < k_ticks; ++tick) sink.offer(sample_at(tick));
  EXPECT_TRUE(take_until(status, statuses, k_ticks));
  EXPECT_TRUE(take_until(tf, transforms, k_ticks));
  EXPECT_TRUE(take_until(pose, poses, 1));  // keep_last 1: the newest at least
  EXPECT_EQ(statuses.size(), k_ticks);
  EXPECT_EQ(transforms.size(), k_ticks);

  for (Bytes& bytes : poses) {
    Decoder decoder(bytes);
    const auto seconds = decoder.next<std::int32_t>();
    const auto nanoseconds = decoder.next<std::uint32_t>();
    const Duration since_start =
        Time{std::int64_t{seconds} * 1'000'000'000 + nanoseconds} - (Time{} + k_clock_start);
    const PoseSample expected =
        sample_at(static_cast<std::uint32_t>(since_start.nanoseconds / k_period.nanoseconds));
    EXPECT_EQ(decoder.next<std::string>(), "robot_base");
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(decoder.next<double>(), expected.pose.translation[i]);
    }
    for (const double part : {-0.5, 0.5, 0.5, 0.5}) EXPECT_EQ(decoder.next<double>(), part);
  }
  Decoder first(late_transforms.front());
  EXPECT_EQ(first.next<std::uint32_t>(), 1U);
  (void)first.next<std::int32_t>();
  (void)first.next<std::uint32_t>();
  EXPECT_EQ(first.next<std::string>(), "hmd_world");
  EXPECT_EQ(first.next<std::string>(), "robot_base");
  EXPECT_EQ(first.next<double>(), 0.6);
  Decoder description(descriptions.front());
  EXPECT_EQ(description.next<std::string>(), settings.robot_description);
  for (const auto& [topic, type] :
       {std::pair{"rt/glint/pen_pose", pose_stamped_type()}, std::pair{"rt/tf", tf_type()},
        std::pair{"rt/robot_description", text_type()}}) {
    EXPECT_EQ(subscriber.user_data_of(topic),
              std::string("typehash=RIHS01_") + type.type_hash + ";");
  }
}

}  // namespace
}  // namespace glint::fast_dds_test
