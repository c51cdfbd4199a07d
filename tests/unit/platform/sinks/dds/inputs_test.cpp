// Joint states, description, pose guess and buttons received from another participant.
#include "platform/sinks/dds/dds_inputs.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "platform/sinks/dds/dds_sink.hpp"
#include "platform/sinks/dds/network.hpp"
#include "tests/unit/platform/sinks/dds/inputs.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"

namespace glint {
namespace {

using Inputs = DdsTest;

bool found(dds_entity_t writer) {
  return wait_until([&] { return has_reader(writer); });
}

// Both ends, in separate Cyclone domains.
struct Ends {
  std::vector<ButtonEvent> events;  // written and read by this thread only
  DdsInputs inputs;
  Peer peer;

  Ends()
      : inputs(DdsProcess::of(test_settings()), test_settings(),
               [this](const ButtonEvent& event) { events.push_back(event); }),
        peer(test_settings()) {}

  // Alternates writing and reading until `done` returns true.
  template <class Done>
  bool read_until(Done done) {
    return wait_until([&] {
      inputs.read(milliseconds(2));
      return done();
    });
  }
};

TEST_F(Inputs, HandOverTheNewestJointStateOfABestEffortDriver) {
  Ends ends;
  const dds_entity_t writer =
      ends.peer.writer(joint_state_type(), "rt/joint_states", Reliability::best_effort,
                       Durability::volatile_data, 5);
  ASSERT_TRUE(found(writer));
  double angle = 0;
  EXPECT_TRUE(ends.read_until([&] {
    JointText text({"shoulder", "elbow"}, {angle += 0.1, 2});
    const JointStateMessage message = text.message();
    dds_write(writer, &message);
    return ends.inputs.counts().joints >= 3;
  }));
  ASSERT_TRUE(ends.inputs.joints().sample());
  const ReceivedJoints& joints = ends.inputs.joints().value();
  EXPECT_EQ(joints.count, 2);
  EXPECT_STREQ(joints.names[0].data(), "shoulder");
  EXPECT_GT(joints.positions[0], 0.25);
  EXPECT_EQ(ends.inputs.joints().version(), ends.inputs.counts().joints);
}

TEST_F(Inputs, HearADescriptionThatWasPublishedBefore) {
  Peer peer(test_settings());
  const dds_entity_t writer = peer.writer(text_type(), "rt/robot_description",
                                          Reliability::reliable, Durability::transient_local, 1);
  std::string urdf(200'000, ' ');
  urdf.front() = '<';
  urdf.back() = '>';
  const TextMessage message{urdf.data()};
  ASSERT_EQ(dds_write(writer, &message), DDS_RETCODE_OK);
  DdsInputs inputs(DdsProcess::of(test_settings()), test_settings(), {});
  EXPECT_TRUE(wait_until([&] {
    inputs.read(milliseconds(2));
    return inputs.description().sample();
  }));
  EXPECT_EQ(inputs.description().value().urdf, urdf);
}

TEST_F(Inputs, TakeRvizsGuess) {
  Ends ends;
  const dds_entity_t writer =
      ends.peer.writer(pose_covariance_type(), "rt/initialpose", Reliability::reliable,
                       Durability::volatile_data, 10);
  ASSERT_TRUE(found(writer));
  std::string frame = "hmd_world";
  const PoseCovarianceMessage message = guess_message(frame);
  dds_write(writer, &message);
  EXPECT_TRUE(ends.read_until([&] { return ends.inputs.initial_pose().sample(); }));
  EXPECT_EQ(ends.inputs.initial_pose().value().pose.translation, Vector3(1, 2, 3));
}

TEST_F(Inputs, GiveEachChangeOfAButtonOnce) {
  Ends ends;
  const dds_entity_t draw = ends.peer.writer(bool_type(), "rt/glint/button", Reliability::reliable,
                                             Durability::volatile_data, 64);
  const dds_entity_t undo = ends.peer.writer(bool_type(), "rt/glint/button_undo",
                                             Reliability::reliable, Durability::volatile_data, 64);
  ASSERT_TRUE(found(draw) && found(undo));
  const Time before = Time{dds_time()} - k_clock_start;
  for (const bool down : {false, true, true, true, false, true}) {
    const BoolMessage message{down};
    dds_write(draw, &message);
  }
  const BoolMessage pressed{true};
  dds_write(undo, &pressed);
  EXPECT_TRUE(ends.read_until([&] { return ends.inputs.counts().buttons == 7; }));
  ASSERT_EQ(ends.events.size(), 4u);
  std::vector<bool> states;
  int undone = 0;
  for (const ButtonEvent& event : ends.events) {
    EXPECT_GE(event.time, before);
    // The arrival is of another clock, which runs faster by its adjustment: at most 500 ppm.
    const Time now = Time{dds_time()} - k_clock_start;
    const Duration ahead{1000 + (now - before).nanoseconds / 2000};
    EXPECT_LE(event.time, now + ahead);
    if (event.button == Button::draw) states.push_back(event.pressed);
    undone += event.button == Button::undo ? 1 : 0;
  }
  EXPECT_EQ(states, (std::vector<bool>{true, false, true}));
  EXPECT_EQ(undone, 1);
}

// Publishes a pressed button from this participant.
void press_button(Peer& peer, const char* topic) {
  const dds_entity_t writer =
      peer.writer(bool_type(), topic, Reliability::reliable, Durability::volatile_data, 64);
  ASSERT_TRUE(found(writer));
  const BoolMessage pressed{true};
  ASSERT_EQ(dds_write(writer, &pressed), DDS_RETCODE_OK);
}

TEST_F(Inputs, ReleaseAButtonWhoseParticipantLeaves) {
  Ends ends;
  auto leaving = std::make_unique<Peer>(test_settings(), 201);
  press_button(*leaving, "rt/glint/button");
  press_button(ends.peer, "rt/glint/button_undo");
  ASSERT_TRUE(ends.read_until([&] { return ends.events.size() == 2; }));
  leaving.reset();
  ASSERT_TRUE(ends.read_until([&] { return ends.events.size() == 3; }));
  EXPECT_EQ(ends.events[2].button, Button::draw);
  EXPECT_FALSE(ends.events[2].pressed);
  EXPECT_EQ(ends.inputs.counts().released, 1u) << "the other participant holds its button";
}

// A second participant on the topic never held the button, so it does not keep the button pressed.
TEST_F(Inputs, ReleaseAButtonWhoseParticipantLeavesBesideAnotherOnItsTopic) {
  Ends ends;
  ASSERT_TRUE(found(ends.peer.writer(bool_type(), "rt/glint/button", Reliability::reliable,
                                     Durability::volatile_data, 64)));
  auto leaving = std::make_unique<Peer>(test_settings(), 201);
  press_button(*leaving, "rt/glint/button");
  ASSERT_TRUE(ends.read_until([&] { return ends.events.size() == 1; }));
  leaving.reset();
  EXPECT_TRUE(ends.read_until([&] { return ends.events.size() == 2; }));
}

// A killed participant sends no dispose; its lease expires. Must run before this process starts
// any thread, because it forks.
TEST_F(Inputs, ReleaseAButtonWhoseParticipantWasKilled) {
  const pid_t child = ::fork();
  if (child == 0) {
    Peer peer(test_settings(), 201, "<LeaseDuration>500ms</LeaseDuration>");
    press_button(peer, "rt/glint/button");
    ::pause();
  }
  ASSERT_GT(child, 0);
  std::vector<ButtonEvent> events;
  DdsInputs inputs(DdsProcess::of(test_settings()), test_settings(),
                   [&](const ButtonEvent& event) { events.push_back(event); });
  const auto read_until = [&](std::size_t count) {
    return wait_until([&] {
      inputs.read(milliseconds(2));
      return events.size() == count;
    });
  };
  EXPECT_TRUE(read_until(1));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_TRUE(read_until(2));
  EXPECT_EQ(inputs.counts().released, 1u);
}

TEST_F(Inputs, ReleaseAButtonThatNobodyRepeatsWithinTheTimeout) {
  DdsSettings settings = test_settings();
  settings.button_timeout = milliseconds(40);
  std::vector<ButtonEvent> events;
  DdsInputs inputs(DdsProcess::of(settings), settings,
                   [&](const ButtonEvent& event) { events.push_back(event); });
  Peer peer(settings);
  press_button(peer, "rt/glint/button");
  ASSERT_TRUE(wait_until([&] {
    inputs.read(milliseconds(2));
    return events.size() == 2;
  }));
  EXPECT_FALSE(events[1].pressed);
  EXPECT_GT(events[1].time - events[0].time, settings.button_timeout);
}

TEST_F(Inputs, SayWhichToolsAreNamedToBeThereOrNot) {
  std::vector<std::pair<int, bool>> named;
  DdsSettings settings = test_settings();
  settings.tool_names = {"pen", "spare pen"};
  DdsInputs inputs(DdsProcess::of(settings), settings, {},
                   [&](int tool, bool there) { named.emplace_back(tool, there); });
  Peer peer(settings);
  const dds_entity_t add = peer.writer(text_type(), "rt/glint/tool_add", Reliability::reliable,
                                       Durability::volatile_data, 64);
  const dds_entity_t remove = peer.writer(text_type(), "rt/glint/tool_remove",
                                          Reliability::reliable, Durability::volatile_data, 64);
  ASSERT_TRUE(found(add) && found(remove));
  const auto say = [&](dds_entity_t writer, std::string name) {
    const TextMessage message{name.data()};
    ASSERT_EQ(dds_write(writer, &message), DDS_RETCODE_OK);
  };
  const auto heard = [&](std::uint64_t tools, std::uint64_t refused) {
    return wait_until([&] {
      inputs.read(milliseconds(2));
      return inputs.counts().tools == tools && inputs.counts().refused == refused;
    });
  };
  say(remove, "spare pen");
  EXPECT_TRUE(heard(1, 0));
  say(add, "no such pen");
  say(add, std::string(5000, 'p'));
  EXPECT_TRUE(heard(1, 2));
  say(add, "spare pen");
  EXPECT_TRUE(heard(2, 2));
  EXPECT_EQ(named, (std::vector<std::pair<int, bool>>{{1, false}, {1, true}}));
}

// Rejects too many joints, different lengths, and a description of 5 MB, far above the decoder's
// limit. A valid description in between is received.
TEST_F(Inputs, RefuseAndCountWhatIsTooLargeOrMakesNoSense) {
  Ends ends;
  const dds_entity_t joints = ends.peer.writer(
      joint_state_type(), "rt/joint_states", Reliability::reliable, Durability::volatile_data, 64);
  const dds_entity_t text = ends.peer.writer(text_type(), "rt/robot_description",
                                             Reliability::reliable, Durability::transient_local, 1);
  ASSERT_TRUE(found(joints) && found(text));
  const auto send = [&](JointText hostile) {
    const std::uint64_t refused = ends.inputs.counts().refused;
    // Best effort may lose a message: repeats it until one arrives.
    return ends.read_until([&] {
      const JointStateMessage message = hostile.message();
      dds_write(joints, &message);
      return ends.inputs.counts().refused > refused;
    });
  };
  EXPECT_TRUE(send({std::vector<std::string>(65, "j"), std::vector<double>(65, 1)}));
  EXPECT_TRUE(send({{"a", "b"}, {1}}));
  EXPECT_TRUE(send({std::vector<std::string>(4000, "joint"), std::vector<double>(4000, 1)}));
  EXPECT_EQ(ends.inputs.counts().joints, 0u);
  const std::uint64_t refused = ends.inputs.counts().refused;
  std::string huge(5 << 20, 'x');
  const TextMessage huge_message{huge.data()};
  dds_write(text, &huge_message);
  EXPECT_TRUE(ends.read_until([&] { return ends.inputs.counts().refused > refused; }));
  std::string small = "<robot/>";
  const TextMessage small_message{small.data()};
  dds_write(text, &small_message);
  EXPECT_TRUE(ends.read_until([&] { return ends.inputs.description().sample(); }));
  EXPECT_EQ(ends.inputs.description().value().urdf, "<robot/>");
  EXPECT_EQ(ends.inputs.counts().descriptions, 1u);
}

// The writer has no such limit. The message after the oversized one arrives.
TEST_F(Inputs, NeverSeeAMessageLargerThanTheDomainTakes) {
  Ends ends;
  const dds_entity_t writer = ends.peer.writer(
      text_type(), "rt/robot_description", Reliability::reliable, Durability::transient_local, 8);
  ASSERT_TRUE(found(writer));
  std::string huge(k_message_bytes_max + 1000, 'x');
  const TextMessage huge_message{huge.data()};
  ASSERT_EQ(dds_write(writer, &huge_message), DDS_RETCODE_OK);
  std::string small = "<robot/>";
  const TextMessage small_message{small.data()};
  ASSERT_EQ(dds_write(writer, &small_message), DDS_RETCODE_OK);
  EXPECT_TRUE(ends.read_until([&] { return ends.inputs.description().sample(); }));
  EXPECT_EQ(ends.inputs.description().value().urdf, "<robot/>");
  EXPECT_EQ(ends.inputs.counts().refused, 0u);
}

TEST_F(Inputs, ReadInAThreadBesideASinkInOneDomain) {
  DdsSink sink(test_settings());
  std::mutex mutex;
  std::vector<ButtonEvent> events;
  DdsInputs inputs(sink.process(), test_settings(), [&](const ButtonEvent& event) {
    const std::lock_guard lock(mutex);
    events.push_back(event);
  });
  inputs.start();
  Peer peer(test_settings());
  const dds_entity_t draw = peer.writer(bool_type(), "rt/glint/button", Reliability::reliable,
                                        Durability::volatile_data, 64);
  ASSERT_TRUE(found(draw));
  const BoolMessage pressed{true};
  dds_write(draw, &pressed);
  EXPECT_TRUE(wait_until([&] { return inputs.counts().buttons == 1; }));
  inputs.stop();
  const std::lock_guard lock(mutex);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_TRUE(events[0].pressed);
}

}  // namespace
}  // namespace glint
