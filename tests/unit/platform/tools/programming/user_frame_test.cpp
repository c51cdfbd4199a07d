// User frames through three waypoints, judged by what their axes have to fulfil.
#include "platform/tools/programming/user_frame.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "platform/input_error.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint {
namespace {

std::string frame_error(const std::function<void()>& make) {
  try {
    make();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

PathElement waypoint(const std::string& name, const Vector3& at) {
  return {PathKind::waypoint, {{Time{}, {Quaternion::Identity(), at}, Matrix6::Zero()}}, name};
}

// In its own frame the points are (0, 0, 0), (a, 0, 0) and (b, c, 0), with a and c above 0.
TEST(UserFrame, HasItsPointsAtTheOriginOnXAndInThePlane) {
  test::Random random(5);
  for (int n = 0; n < 500; ++n) {
    const Pose frame{random.rotation(), random.in_box(2)};
    const double a = random.within(0.02, 1), b = random.within(-1, 1), c = random.within(0.02, 1);
    const Pose found =
        frame_through(frame.translation, frame * Vector3(a, 0, 0), frame * Vector3(b, c, 0));
    const Pose back = found.inverse();
    EXPECT_LT((back * (frame * Vector3(a, 0, 0)) - Vector3(a, 0, 0)).norm(), 1e-9);
    EXPECT_LT((back * (frame * Vector3(b, c, 0)) - Vector3(b, c, 0)).norm(), 1e-9);
    EXPECT_LT((found.translation - frame.translation).norm(), 1e-12);
    EXPECT_GT(std::abs(found.rotation.dot(frame.rotation)), 1 - 1e-12);
  }
}

TEST(UserFrame, RefusesPointsThatDetermineNoFrame) {
  const Vector3 o(0.4, 0.1, 0.2);
  const auto error = [&](const Vector3& x, const Vector3& plane) {
    return frame_error([&] { (void)frame_through(o, o + x, o + plane); });
  };
  EXPECT_EQ(error({0.0201, 0, 0}, {0, 0.0201, 0}), "accepted");
  EXPECT_EQ(
      error({0.019, 0, 0}, {0, 0.1, 0}),
      "user frame: the distance from the origin to the point on +x is 19.0 mm; expected 20 mm "
      "or more");
  EXPECT_EQ(error({0.1, 0, 0}, {0, 0, 0.003}),
            "user frame: the distance from the origin to the point in the x-y plane is 3.0 mm; "
            "expected 20 mm or more");
  for (const double along : {0.3, -0.3}) {
    EXPECT_EQ(error({0.1, 0, 0}, {along, 0.012, 0.016 / 2}),
              "user frame: collinear points: the distance from the x axis to the point in the x-y "
              "plane is 14.4 mm; expected 20 mm or more");
  }
  EXPECT_EQ(error({0.1, 0, std::numeric_limits<double>::quiet_NaN()}, {0, 0.1, 0}),
            "user frame: a point that is not finite; expected three finite points");
}

TEST(UserFrame, TakesItsWaypointsOutOfThePath) {
  const DrawnPath path{waypoint("start", {0, 0, 1}), waypoint("o", {1, 0, 0}),
                       waypoint("x", {1, 1, 0}), waypoint("end", {0, 0, 2}),
                       waypoint("xy", {1, 0, 1})};
  const std::vector<std::string> names{"o", "x", "xy"};
  const DrawnPath left = without(path, names);
  ASSERT_EQ(left.size(), 2u);
  EXPECT_EQ(left[0].name, "start");
  EXPECT_EQ(left[1].name, "end");
  // x is the base's y, y its z, z its x.
  EXPECT_LT((user_frame(path, names) * Vector3(0.1, 0.2, 0.3) - Vector3(1.3, 0.1, 0.2)).norm(),
            1e-12);
}

TEST(UserFrame, RefusesNamesThatAreNoThreeWaypoints) {
  DrawnPath path{waypoint("o", {1, 0, 0}), waypoint("x", {1, 1, 0}), waypoint("xy", {1, 0, 1})};
  path.push_back(path[2]);
  path[3].kind = PathKind::stroke;
  path[3].name = "seam";
  const auto error = [&](const std::vector<std::string>& names) {
    return frame_error([&] { (void)user_frame(path, names); });
  };
  EXPECT_EQ(error({"o", "x", "seam"}),
            "user frame: no waypoint \"seam\" in the path; expected three names of waypoints");
  EXPECT_EQ(error({"o", "y", "xy"}),
            "user frame: no waypoint \"y\" in the path; expected three names of waypoints");
  EXPECT_EQ(error({"o", "x", "o"}),
            "user frame: a waypoint given twice; expected three different ones");
}

}  // namespace
}  // namespace glint
