// ROS images, poses and transforms as they arrive: pairing, checks, counts and delivery.
#include "platform/sources/ros_frames.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "platform/runtime/rt/allocation_counter.hpp"
#include "platform/runtime/rt/clock.hpp"
#include "platform/sinks/record/cdr.hpp"
#include "platform/sources/stamp_pairs.hpp"

namespace glint::ros_frames_test {
namespace {

constexpr int k_width = 4, k_height = 3;
constexpr Duration k_period = milliseconds(20);

Camera tiny_camera(int bits) {
  Camera camera = hololens2_ahat();
  camera.model.width = k_width;
  camera.model.height = k_height;
  camera.reflectivity_bits = bits;
  camera.period = k_period;
  camera.exposure = camera.transport = Duration{};
  return camera;
}

void put_header(CdrWriter& to, Time stamp, const char* frame) {
  to.put(static_cast<std::int32_t>(stamp.nanoseconds / 1'000'000'000));
  to.put(static_cast<std::uint32_t>(stamp.nanoseconds % 1'000'000'000));
  to.put(frame);
}

void put_pose(CdrWriter& to, double x) {
  for (const double value : {x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}) to.put(value);
}

struct Sent {
  std::uint32_t width = k_width, height = k_height, step = 2 * k_width;
  const char* encoding = "mono16";
  std::size_t bytes = 2 * k_width * k_height;
  std::uint8_t value = 1;
};

Bytes bytes_of_writer(const CdrWriter& to) { return {to.bytes().begin(), to.bytes().end()}; }

Bytes image_at(Time stamp, const Sent& sent = {}) {
  CdrWriter to;
  put_header(to, stamp, "tof_optical_frame_of_the_headset");
  to.put(sent.height);
  to.put(sent.width);
  to.put(sent.encoding);
  to.put(std::uint8_t{0});
  to.put(sent.step);
  to.put_bytes(Bytes(sent.bytes, sent.value));
  return bytes_of_writer(to);
}

Bytes transform_at(Time stamp, double x) {
  CdrWriter to;
  to.put(std::uint32_t{1});
  put_header(to, stamp, "world_of_the_headset");
  to.put("tof_optical_frame_of_the_headset");
  put_pose(to, x);
  return bytes_of_writer(to);
}

Bytes pose_at(Time stamp, double x) {
  CdrWriter to;
  put_header(to, stamp, "map");
  put_pose(to, x);
  return bytes_of_writer(to);
}

SourceSettings topics() {
  SourceSettings source;
  source.reflectivity_topic = "/ir";
  source.depth_topic = "/depth";
  return source;
}

class RosFramesTest : public testing::Test {
 protected:
  explicit RosFramesTest(int bits = 16) : live_(tiny_camera(bits), {}) {
    live_.start({true, begin_ - milliseconds(1000), [] { return monotonic_now(); }});
  }
  [[nodiscard]] Time stamp(int number) const { return Time{} + k_period * (number + 1); }
  [[nodiscard]] Time arrival(int number) const { return begin_ + k_period * (number + 1); }
  void send(RosFrames& frames, int number, ImageKind kind, const Sent& sent = {},
            std::uint64_t publisher = 1) {
    frames.add_image(image_at(stamp(number), sent), kind, publisher, arrival(number));
  }
  void send_both(RosFrames& frames, int number) {
    send(frames, number, ImageKind::reflectivity);
    send(frames, number, ImageKind::depth);
  }
  [[nodiscard]] static std::uint64_t count(const SourceReport& report, const std::string& name) {
    for (const auto& [key, value] : report.counts) {
      if (key == name) return value;
    }
    ADD_FAILURE() << name;
    return 0;
  }
  [[nodiscard]] SourceReport report(const RosFrames& frames) const {
    SourceReport report;
    frames.add_to(report);
    live_.add_to(report);
    return report;
  }
  // Frames available without waiting.
  std::vector<ArrivedFrame> delivered() {
    std::vector<ArrivedFrame> all;
    for (; taken_ < live_.published(); ++taken_) {
      ArrivedFrame arrived;
      EXPECT_TRUE(live_.wait(arrived));
      live_.release_pixels(arrived);
      all.push_back(arrived);
    }
    return all;
  }

  Time begin_ = monotonic_now();
  LiveSource live_;
  std::uint64_t taken_ = 0;
};

TEST_F(RosFramesTest, PairsByStampInAnyOrderOfTopics) {
  RosFrames frames(live_, topics());
  send(frames, 0, ImageKind::depth, {.value = 7});
  send(frames, 0, ImageKind::reflectivity, {.value = 3});
  send_both(frames, 1);
  const auto all = delivered();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].frame.depth.row(0)[0], 0x0707);
  EXPECT_EQ(all[0].frame.reflectivity_16.row(2)[3], 0x0303);
  EXPECT_FALSE(all[0].head.valid);
  EXPECT_EQ(all[1].frame.mid_exposure - all[0].frame.mid_exposure, k_period);
}

TEST_F(RosFramesTest, CountsImagesThatNeverPair) {
  RosFrames frames(live_, topics());
  for (int i = 0; i < 40; ++i) send(frames, i, ImageKind::reflectivity);
  EXPECT_TRUE(delivered().empty());
  EXPECT_EQ(count(report(frames), "images_unpaired"), 40u);
}

TEST_F(RosFramesTest, RefusesWhatIsNoImageOfTheCamera) {
  RosFrames frames(live_, topics());
  const std::pair<Sent, const char*> wrong[] = {
      {{.encoding = "bgr8"}, "/ir: encoding \"bgr8\"; expected mono8"},
      {{.width = 5, .step = 10, .bytes = 30}, "/ir: 5 x 3 pixels; expected 4 x 3 (hololens2_ahat)"},
      {{.step = 4}, "/ir: 4 x 3 pixels of mono16, 4 bytes a row"},
      {{.bytes = 22}, "and 22 in all; expected rows of exactly these pixels"}};
  for (const auto& [sent, part] : wrong) {
    RosFrames own(live_, topics());
    own.add_image(image_at(stamp(0), sent), ImageKind::reflectivity, 1, arrival(0));
    const SourceReport found = report(own);
    EXPECT_EQ(count(found, "images_refused"), 1u) << part;
    ASSERT_FALSE(found.failures.empty());
    EXPECT_NE(found.failures[0].find(part), std::string::npos) << found.failures[0];
  }
  frames.add_image(Bytes{1, 2, 3}, ImageKind::depth, 1, arrival(0));
  EXPECT_EQ(count(report(frames), "images_refused"), 1u);
  EXPECT_TRUE(delivered().empty());
}

TEST_F(RosFramesTest, CountsDoubledAndBackwardStamps) {
  RosFrames frames(live_, topics());
  send_both(frames, 3);
  send_both(frames, 3);
  send_both(frames, 2);
  EXPECT_EQ(delivered().size(), 1u);
  EXPECT_EQ(count(report(frames), "stamps_doubled_or_backward"), 4u);
}

// The source changes to a second publisher only after the first one is silent.
TEST_F(RosFramesTest, FollowsOnePublisherUntilItIsSilent) {
  RosFrames frames(live_, topics());
  send_both(frames, 0);
  send(frames, 1, ImageKind::reflectivity, {}, 2);
  EXPECT_EQ(count(report(frames), "images_of_another_publisher"), 1u);
  const int later = static_cast<int>(k_publisher_silent.nanoseconds / k_period.nanoseconds) + 1;
  // Its clock started later.
  for (const ImageKind kind : {ImageKind::reflectivity, ImageKind::depth}) {
    frames.add_image(image_at(stamp(0)), kind, 2, arrival(later));
  }
  EXPECT_EQ(delivered().size(), 2u);
  EXPECT_EQ(frames.publishers(), 2u);
}

TEST_F(RosFramesTest, WaitsForALaterTransformAndKeepsTheOrder) {
  SourceSettings source = topics();
  source.world_frame = "world_of_the_headset";
  RosFrames frames(live_, source);
  frames.add_transforms(transform_at(stamp(0), 0), false);
  send_both(frames, 1);
  send_both(frames, 2);
  EXPECT_TRUE(delivered().empty());
  frames.add_transforms(transform_at(stamp(2), 2), false);
  frames.publish_ready(arrival(2));
  const auto all = delivered();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_TRUE(all[0].head.valid && all[1].head.valid);
  EXPECT_NEAR(all[0].head.T_world_camera.translation.x(), 1, 1e-12);
  EXPECT_EQ(all[1].head.T_world_camera.translation.x(), 2);
}

TEST_F(RosFramesTest, GivesAFrameWithoutHeadPoseWhereNoneCame) {
  SourceSettings source = topics();
  source.pose_topic = "/pose";
  RosFrames frames(live_, source);
  frames.add_pose(pose_at(stamp(0), 1));
  send_both(frames, 1);
  frames.publish_ready(arrival(1) + k_period);
  EXPECT_TRUE(delivered().empty());
  EXPECT_EQ(frames.due(), arrival(1) + k_period * k_pose_wait_gaps);
  frames.publish_ready(frames.due());
  const auto all = delivered();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_FALSE(all[0].head.valid);
  EXPECT_EQ(count(report(frames), "head_poses_late"), 1u);
  EXPECT_EQ(count(report(frames), "frames_without_head_pose"), 1u);
  send_both(frames, 60);  // the poses stopped long ago: no wait
  EXPECT_EQ(delivered().size(), 1u);
}

class RosFramesOfEightBits : public RosFramesTest {
 protected:
  RosFramesOfEightBits() : RosFramesTest(8) {}
};

TEST_F(RosFramesOfEightBits, AreNarrowedOrRefused) {
  RosFrames frames(live_, topics());
  send(frames, 0, ImageKind::depth);
  send(frames, 0, ImageKind::reflectivity,
       {.step = k_width, .encoding = "mono8", .bytes = k_width * k_height, .value = 200});
  send(frames, 1, ImageKind::reflectivity);
  const auto all = delivered();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].frame.reflectivity_8.row(0)[0], 200);
  const SourceReport found = report(frames);
  ASSERT_FALSE(found.failures.empty());
  EXPECT_NE(found.failures[0].find("/ir: a value of 257; expected at most 255"), std::string::npos);
}

TEST_F(RosFramesTest, TakesNoHeapOnceItsTransformsAreThere) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "allocations are not counted here";
  SourceSettings source = topics();
  source.world_frame = "world_of_the_headset";
  RosFrames frames(live_, source);
  std::vector<std::pair<Bytes, Bytes>> messages;
  for (int i = 0; i < 3000; ++i) {
    messages.emplace_back(image_at(stamp(i)), transform_at(stamp(i), i));
  }
  frames.add_transforms(transform_at(stamp(-1), 0), false);
  const std::uint64_t before = AllocationCounter::count();
  AllocationCounter::arm();
  for (int i = 0; i < 3000; ++i) {
    const auto& [image, transform] = messages[static_cast<std::size_t>(i)];
    frames.add_image(image, ImageKind::reflectivity, 1, arrival(i));
    if (i % 7 != 0) frames.add_image(image, ImageKind::depth, 1, arrival(i));
    frames.add_transforms(transform, false);
    frames.publish_ready(arrival(i));
    ArrivedFrame arrived;
    if (i % 7 != 0 && live_.wait(arrived)) live_.release_pixels(arrived);
  }
  AllocationCounter::disarm();
  EXPECT_EQ(AllocationCounter::count() - before, 0u);
  EXPECT_EQ(count(report(frames), "frames_dropped"), 0u);
}

}  // namespace
}  // namespace glint::ros_frames_test
