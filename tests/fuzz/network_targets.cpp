// Fuzz targets of DDS messages, unpacked by Cyclone's functions as in a reader, and of CAN frames.
#include <dds/ddsi/ddsi_cdrstream.h>

#include <algorithm>
#include <string>
#include <vector>

#include "kernels/wire/can_decode.hpp"
#include "platform/sinks/can/button_frames.hpp"
#include "platform/sinks/dds/received_messages.hpp"
#include "platform/sinks/dds/topic_types.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace glint::fuzz {
namespace {

constexpr std::uint32_t k_xcdr1 = 1;

// As ddsi_serdata_to_sample: checks the lengths, then unpacks. Calls `use` with valid messages
// only.
template <class Message, class Use>
void unpack(Bytes bytes, const TopicType& type, Use use) {
  std::vector<char> data(bytes.begin(), bytes.end());
  const auto size = static_cast<std::uint32_t>(data.size());
  std::uint32_t end = 0;
  const std::uint32_t* operations = type.descriptor->m_ops;
  if (data.empty() ||
      dds_stream_normalize_data(data.data(), &end, size, false, k_xcdr1, operations) == nullptr) {
    return;
  }
  dds_istream_t stream;
  dds_istream_init(&stream, end, data.data(), k_xcdr1);
  Message message{};
  (void)dds_stream_read(&stream, reinterpret_cast<char*>(&message), operations);
  use(message);
  dds_stream_free_sample(&message, operations);
}

void read_joint_state(Bytes bytes) {
  unpack<JointStateMessage>(bytes, joint_state_type(), [](const JointStateMessage& message) {
    ReceivedJoints joints;
    if (!read_message(message, {}, {}, joints)) return;
    std::vector<std::string> names;
    for (int i = 0; i < joints.count; ++i) {
      names.emplace_back(joints.names[static_cast<std::size_t>(i)].data());
    }
    std::vector<double> positions(names.size());
    expect(positions_of(joints, names, positions) <= names.size(), "joints that are there");
  });
}

void read_description(Bytes bytes) {
  unpack<TextMessage>(bytes, text_type(), [](const TextMessage& message) {
    ReceivedDescription description;
    (void)read_message(message, description);
  });
}

void read_guess(Bytes bytes) {
  unpack<PoseCovarianceMessage>(bytes, pose_covariance_type(),
                                [](const PoseCovarianceMessage& message) {
                                  ReceivedInitialPose guess;
                                  if (!read_message(message, {}, {}, guess)) return;
                                  expect(guess.pose.translation.allFinite(), "a finite guess");
                                });
}

void read_button_message(Bytes bytes) {
  unpack<BoolMessage>(bytes, bool_type(), [](const BoolMessage&) {});
}

void read_can_frame(Bytes bytes) {
  const auto frame = frame_of_socketcan(bytes);
  ButtonFrames buttons(0x181, {});
  buttons.receive(frame, {});
  if (!frame) return;
  expect(frame->length <= frame->data.size(), "no more data than there is room");
  (void)decode_position(*frame);
  (void)decode_orientation(*frame);
  (void)decode_velocity(*frame);
  (void)decode_angular_velocity(*frame);
  (void)decode_quality(*frame);
  (void)decode_fd_pose(*frame);
}

constexpr Target k_network_targets[] = {{"cdr_joint_states", read_joint_state},
                                        {"cdr_text", read_description},
                                        {"cdr_initial_pose", read_guess},
                                        {"cdr_button", read_button_message},
                                        {"can_frame", read_can_frame}};

}  // namespace

std::span<const Target> network_targets() { return k_network_targets; }

}  // namespace glint::fuzz
