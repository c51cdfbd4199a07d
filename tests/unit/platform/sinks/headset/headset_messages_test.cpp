#include "platform/sinks/headset/headset_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace glint {
namespace {

using Json = nlohmann::json;

constexpr std::size_t k_robot = k_tools_max, k_first_stroke = k_tools_max + 1;
constexpr Duration k_tick = milliseconds(4);

HeadsetSample sample_at(int tick) {
  HeadsetSample given;
  given.unix_offset = {1'700'000'000'000'000'000};
  PoseSample& sample = given.sample;
  sample.tick = Time{} + k_tick * tick;
  sample.measurement = sample.tick - milliseconds(10);
  sample.tick_number = static_cast<std::uint64_t>(tick);
  sample.state = TrackState::measured;
  sample.reason = Reason::none;
  sample.frame = ReferenceFrame::world;
  sample.pose.translation = {0.1, 0.2, -0.3};
  sample.covariance.topLeftCorner<3, 3>() = Vector3(1e-6, 4e-6, 9e-6).asDiagonal();
  return given;
}

void add(HeadsetMessages& messages, const HeadsetSample& sample) {
  messages.add(sample);
  messages.publish_due();
}

Json message(const HeadsetMessages& messages, std::size_t slot) {
  return Json::parse(messages.text(slot));
}

void expect_near(const Json& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size()) << found;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(found[i].get<double>(), expected[i], 2e-6) << found;
  }
}

TEST(HeadsetMessages, MirrorZOfVectorsAndXAndYOfRotations) {
  HeadsetMessages messages({"pen"});
  HeadsetSample given = sample_at(1);
  // 90 degrees about x: the shaft's z axis points along -y.
  given.sample.pose.rotation = Quaternion(std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2, 0, 0);
  add(messages, given);
  const Json pen = message(messages, 0);
  EXPECT_EQ(pen["type"], "pen");
  EXPECT_EQ(pen["unix_ms"], 1'700'000'000'004);
  EXPECT_EQ(pen["age_ms"], 10.0);
  expect_near(pen["tip_m"], {0.1, 0.2, 0.3});
  expect_near(pen["direction"], {0, -1, 0});
  expect_near(pen["rotation"], {-0.707107, 0, 0, 0.707107});
  const double radius = std::sqrt(7.814728);
  expect_near(pen["ellipsoid"]["semi_axes_m"], {1e-3 * radius, 2e-3 * radius, 3e-3 * radius});
  expect_near(pen["ellipsoid"]["rotation"], {0, 0, 0, 1});
}

TEST(HeadsetMessages, ConvertTheRobotsFrameToTheWorld) {
  HeadsetMessages messages({"pen"});
  HeadsetSample given = sample_at(1);
  given.sample.frame = ReferenceFrame::robot;
  add(messages, given);
  EXPECT_TRUE(message(messages, 0)["tip_m"].is_null()) << "no robot";
  EXPECT_EQ(messages.version(k_robot), 0u);
  given.sample.tick = given.sample.tick + k_tick;
  given.robot.state = RegistrationState::given;
  given.robot.T_world_robot.translation = {1, 2, 3};
  add(messages, given);
  expect_near(message(messages, 0)["tip_m"], {1.1, 2.2, -2.7});
  expect_near(message(messages, k_robot)["position_m"], {1, 2, -3});
  given.robot.in_reference = true;
  add(messages, given);
  EXPECT_TRUE(message(messages, 0)["tip_m"].is_null()) << "in a reference body's frame";
  EXPECT_TRUE(message(messages, k_robot)["position_m"].is_null());
}

TEST(HeadsetMessages, RiseThirtyTimesASecondAndAtAChangeOfState) {
  HeadsetMessages messages({"pen", "board"});
  for (int tick = 1; tick <= 250; ++tick) add(messages, sample_at(tick));
  EXPECT_NEAR(static_cast<double>(messages.version(0)), 28, 2);  // every ninth tick
  EXPECT_EQ(messages.version(1), 0u);
  const std::uint64_t before = messages.version(0);
  HeadsetSample lost = sample_at(251);
  lost.sample.state = TrackState::lost;
  lost.sample.reason = Reason::too_old;
  add(messages, lost);
  EXPECT_EQ(messages.version(0), before + 1);
  const Json pen = message(messages, 0);
  EXPECT_EQ(pen["state"], "lost");
  EXPECT_EQ(pen["reason"], "too_old");
  EXPECT_TRUE(pen["tip_m"].is_null());
  EXPECT_TRUE(pen["ellipsoid"].is_null());
}

TEST(HeadsetMessages, RiseOnceForSamplesThatArriveTogether) {
  HeadsetMessages messages({"pen"});
  for (int tick = 1; tick <= 100; ++tick) messages.add(sample_at(tick));
  EXPECT_EQ(messages.version(0), 0u);
  messages.publish_due();
  EXPECT_EQ(messages.version(0), 1u);
  EXPECT_EQ(message(messages, 0)["tick"], 100);
}

TEST(HeadsetMessages, KeepTheNewestStrokesAndTheirShapeWithinTheCapacity) {
  HeadsetMessages messages({"pen"});
  int tick = 0;
  const auto draw = [&](int samples) {
    for (int i = 0; i < samples; ++i) {
      HeadsetSample given = sample_at(++tick);
      given.sample.buttons = 1;
      given.sample.pose.translation = {1.001e-3 * i, 0, 0};
      add(messages, given);
    }
    add(messages, sample_at(++tick));
  };
  draw(101);
  Json stroke = message(messages, k_first_stroke);
  EXPECT_EQ(stroke["stroke"], 1);
  EXPECT_EQ(stroke["done"], true);
  EXPECT_EQ(stroke["points_m"].size(), 51u);  // 2 mm apart
  draw(5000);
  stroke = message(messages, k_first_stroke + 1);
  EXPECT_LE(stroke["points_m"].size(), HeadsetMessages::k_stroke_points_max);
  EXPECT_GE(stroke["points_m"].size(), HeadsetMessages::k_stroke_points_max / 2);
  EXPECT_NEAR(stroke["points_m"].front()[0].get<double>(), 0, 1e-6);
  EXPECT_NEAR(stroke["points_m"].back()[0].get<double>(), 5.004, 0.02);
  for (int i = 0; i < 15; ++i) draw(5);
  EXPECT_EQ(message(messages, k_first_stroke)["stroke"], 17);
  EXPECT_EQ(message(messages, k_first_stroke + 1)["stroke"], 2);
}

TEST(HeadsetMessages, HoldThePointsOfMeasuredPosesAlone) {
  HeadsetMessages messages({"pen"});
  for (int tick = 1; tick < 50; ++tick) {
    HeadsetSample given = sample_at(tick);
    given.sample.buttons = 1;
    given.sample.pose.translation = {0.01 * tick, 0, 0};
    given.sample.state = tick < 10 ? TrackState::measured : TrackState::predicted;
    add(messages, given);
  }
  EXPECT_EQ(message(messages, k_first_stroke)["points_m"].size(), 9u);
  EXPECT_EQ(message(messages, k_first_stroke)["age_ms"], 4.0 * (49 - 9) + 10);
}

}  // namespace
}  // namespace glint
