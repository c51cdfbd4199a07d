// tf transforms of a robot whose pose is given relative to the reference body.
#include <gtest/gtest.h>

#include <memory>
#include <string_view>
#include <vector>

#include "platform/cells/cell.hpp"
#include "platform/runtime/session/frame_group.hpp"
#include "platform/runtime/session/sinks.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

namespace glint {
namespace {

// Replaces the tracker: the reference body has a pose from the second frame on.
class LateReferenceBody final : public FrameMethod {
 public:
  const Estimates& process(const ArrivedFrame& arrived) override {
    estimates_.has_reference = arrived.frame.sequence > 1;
    estimates_.T_world_reference.translation = Vector3(0, 0, 2);
    return estimates_;
  }

 private:
  Estimates estimates_;
};

using FrameTransformsOfARun = DdsTest;

TEST_F(FrameTransformsOfARun, TellWhereTheRobotOnTheBodyIsWhileTheBodyIsKnown) {
  const TemporaryFolder folder;
  Cell cell = default_cell();
  cell.robot_valid = cell.robot_in_reference = true;
  cell.T_world_robot = {Quaternion::Identity(), Vector3(0.5, 0, 0)};
  SinkOptions options;
  options.out = folder.file("");
  options.with_reader = false;
  Sinks sinks(cell, options, k_clock_start.nanoseconds);
  Peer peer(test_settings());
  const dds_entity_t statics = peer.reader(tf_type(), k_tf_static_topic, Reliability::reliable,
                                           Durability::transient_local, 10);
  const dds_entity_t moving =
      peer.reader(tf_type(), k_tf_topic, Reliability::reliable, Durability::volatile_data, 10);
  ASSERT_TRUE(peer.wait_for_discovery(*sinks.dds()));
  EXPECT_EQ(take<TfMessage>(statics, 1,
                            [](const TfMessage& message) {
                              EXPECT_EQ(message.transforms._length, 0u)
                                  << "a place on the body is none in the world";
                            }),
            1u);

  graph::TripleBuffer<ToolSet> tools;
  GroupRunner<Tracker> runner(RunnerSettings<Tracker>{});
  FrameGroup group(
      cell, tools, [] { return Time{}; }, runner, nullptr, std::make_unique<LateReferenceBody>());
  group.publish_transforms_to(sinks.dds());
  for (std::uint32_t sequence = 1; sequence <= 2; ++sequence) {
    ArrivedFrame arrived;
    arrived.frame.sequence = sequence;
    arrived.frame.mid_exposure = arrived.head.time = Time{} + milliseconds(22) * sequence;
    arrived.head.valid = true;
    group.process(arrived);
  }
  std::vector<std::uint32_t> lengths;
  EXPECT_EQ(take<TfMessage>(moving, 2,
                            [&](const TfMessage& message) {
                              lengths.push_back(message.transforms._length);
                              if (message.transforms._length < 2) return;
                              const TransformMessage& robot = message.transforms._buffer[1];
                              EXPECT_EQ(std::string_view(robot.child_frame_id), "robot_base");
                              EXPECT_EQ(robot.transform.translation.x, 0.5);
                              EXPECT_EQ(robot.transform.translation.z, 2);
                            }),
            2u);
  EXPECT_EQ(lengths, (std::vector<std::uint32_t>{1, 2}));
}

}  // namespace
}  // namespace glint
