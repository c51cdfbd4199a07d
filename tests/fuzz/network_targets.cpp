// Fuzz targets of serialised DDS messages, and of CAN frames.
#include <algorithm>
#include <string>
#include <vector>

#include "kernels/wire/can_decode.hpp"
#include "platform/sinks/can/button_frames.hpp"
#include "platform/sinks/dds/received_messages.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace glint::fuzz {
namespace {

void read_joint_state(Bytes bytes) {
  ReceivedJoints joints;
  if (!read_message(bytes, {}, {}, joints)) return;
  std::vector<std::string> names;
  for (int i = 0; i < joints.count; ++i) {
    names.emplace_back(joints.names[static_cast<std::size_t>(i)].data());
  }
  std::vector<double> positions(names.size());
  expect(positions_of(joints, names, positions) <= names.size(), "joints that are there");
}

void read_description(Bytes bytes) {
  ReceivedDescription description;
  if (!read_message(bytes, description)) return;
  expect(description.urdf.size() <= k_received_description_max, "a bounded description");
}

void read_guess(Bytes bytes) {
  ReceivedInitialPose guess;
  if (!read_message(bytes, {}, {}, guess)) return;
  expect(guess.pose.translation.allFinite(), "a finite guess");
}

void read_button_message(Bytes bytes) {
  bool pressed = false;
  (void)read_message(bytes, pressed);
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
