// Edits of a path and its JSON file. Geometry is judged by Monte Carlo or by matrices written here.
#include "platform/tools/programming/stroke_edits.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "kernels/motion/interpolate.hpp"
#include "kernels/motion/motion_filter.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/programming/strokes_json.hpp"
#include "tests/unit/beside_test.hpp"
#include "tests/unit/kernels/pose/scene.hpp"
#include "tests/unit/repetitions.hpp"
#include "tests/unit/text_of.hpp"

namespace glint {
namespace {

Matrix6 random_covariance(test::Random& random) {
  Matrix6 root;
  for (int i = 0; i < 36; ++i) root(i) = random.normal();
  root.topRows<3>() *= 1e-3;
  root.bottomRows<3>() *= 5e-3;
  return root * root.transpose();
}

PathElement random_stroke(test::Random& random, const std::string& name, int points) {
  PathElement stroke{PathKind::stroke, {}, name};
  for (int i = 0; i < points; ++i)
    stroke.points.push_back(
        {Time{1000 * i}, {random.rotation(), random.vector(0.1)}, random_covariance(random)});
  return stroke;
}

DrawnPath sample_of_edits() {
  test::Random random(11);
  DrawnPath path{random_stroke(random, "a", 4), random_stroke(random, "b", 3),
                 random_stroke(random, "c", 5)};
  path.push_back({PathKind::waypoint, {path[0].points[0]}, "w"});
  return path;
}

std::string names_of(const DrawnPath& path) {
  std::string names;
  for (const PathElement& element : path) names += element.name + ' ';
  return names;
}

std::string error_of(const std::vector<std::string>& edits) {
  try {
    (void)edited(sample_of_edits(), edits);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(StrokeEdits, NumberElementsWithoutAName) {
  DrawnPath path = sample_of_edits();
  path[1].name.clear();
  path[3].name.clear();
  path[2].name = "a";
  EXPECT_EQ(names_of(named(path)), "a stroke_2 a_ waypoint_4 ");
}

TEST(StrokeEdits, DeleteRenameAndReplaceInTheirOrder) {
  const DrawnPath path = sample_of_edits();
  const DrawnPath out = edited(path, {"delete b", "rename a seam", "replace seam c"});
  EXPECT_EQ(names_of(out), "seam w ");
  ASSERT_EQ(out[0].points.size(), 5u);
  EXPECT_EQ(out[0].points[4].pose.translation, path[2].points[4].pose.translation);
  EXPECT_EQ(names_of(edited(path, {"replace c a"})), "b c w ");
  EXPECT_TRUE(edited(path, {"delete *"}).empty());
  EXPECT_EQ(names_of(edited(path, {"rename a a"})), names_of(path));
}

TEST(StrokeEdits, OffsetAlongADirectionLeavesCovariances) {
  const DrawnPath path = sample_of_edits();
  const DrawnPath out = edited(path, {"offset * 0,3,4 -5mm"});
  for (std::size_t e = 0; e < path.size(); ++e) {
    for (std::size_t p = 0; p < path[e].points.size(); ++p) {
      const Vector3 moved = out[e].points[p].pose.translation - path[e].points[p].pose.translation;
      EXPECT_LT((moved - Vector3(0, -0.003, -0.004)).norm(), 1e-15);
      EXPECT_EQ(out[e].points[p].covariance, path[e].points[p].covariance);
    }
  }
}

// Samples of each point's error are edited as poses; their differences have the edited covariance.
void expect_monte_carlo(const std::string& edit) {
  test::Random random(5);
  const DrawnPath path{random_stroke(random, "a", 2)};
  const DrawnPath out = edited(path, {edit});
  for (const std::size_t p : {0, 1}) {
    const UncertainPose& point = path[0].points[p];
    const Matrix6 root = point.covariance.llt().matrixL();
    Matrix6 sum = Matrix6::Zero();
    const int samples = test::repetitions(20'000, 4'000);
    for (int n = 0; n < samples; ++n) {
      Vector6 error;
      for (int i = 0; i < 6; ++i) error[i] = random.normal();
      error = (root * error).eval();
      DrawnPath other = path;
      Pose& pose = other[0].points[p].pose;
      pose.translation += error.head<3>();
      pose.rotation = from_rotation_vector(error.tail<3>()) * pose.rotation;
      const DrawnPath moved = edited(other, {edit});
      const Vector6 off = pose_difference(moved[0].points[p].pose, out[0].points[p].pose);
      sum += off * off.transpose() / samples;
    }
    const Matrix6& stated = out[0].points[p].covariance;
    const double bar = 5 * std::sqrt(2.0 / samples);  // 5 sigma of a sample variance
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        EXPECT_NEAR(sum(i, j), stated(i, j), bar * std::sqrt(stated(i, i) * stated(j, j)))
            << edit << ' ' << i << ' ' << j;
  }
}

TEST(StrokeEdits, CovariancesFollowAnOffsetAlongTheTool) {
  expect_monte_carlo("offset a tool 20cm");
}

TEST(StrokeEdits, CovariancesFollowAMirror) { expect_monte_carlo("mirror a 0.1,0,0.2 1,2,-1"); }

TEST(StrokeEdits, OffsetAlongTheToolLeavesItsAxis) {
  const DrawnPath path = sample_of_edits();
  const DrawnPath out = edited(path, {"offset a tool 2cm"});
  const Vector3 local = path[0].points[2].pose.inverse() * out[0].points[2].pose.translation;
  EXPECT_LT((local - Vector3(0, 0, 0.02)).norm(), 1e-15);
}

// A circle in a tilted plane; the tool stands on its other side, tilted by 40 degrees.
TEST(StrokeEdits, OffsetAlongTheNormalIsOnTheToolsSide) {
  const Vector3 normal = Vector3(0.3, -0.4, 0.8).normalized();
  const Quaternion plane = Quaternion::FromTwoVectors(Vector3::UnitZ(), normal);
  test::Random random(3);
  for (const double side : {1.0, -1.0}) {
    const Vector3 tool = plane * Vector3(std::sin(0.7), 0, side * std::cos(0.7));
    DrawnPath path{{PathKind::stroke, {}, "ring"}};
    for (int i = 0; i < 40; ++i) {
      const double angle = i * std::numbers::pi / 20;
      path[0].points.push_back({Time{i},
                                {Quaternion::FromTwoVectors(Vector3::UnitZ(), tool),
                                 plane * Vector3(0.05 * std::cos(angle), 0.05 * std::sin(angle),
                                                 0.0003 * random.normal())},
                                Matrix6::Identity() * 1e-8});
    }
    const DrawnPath out = edited(path, {"offset ring normal 10mm"});
    const Vector3 moved = out[0].points[7].pose.translation - path[0].points[7].pose.translation;
    EXPECT_NEAR(moved.norm(), 0.01, 1e-12);
    EXPECT_GT(moved.dot(side * normal), 0.01 * std::cos(0.01));
  }
  EXPECT_NE(error_of({"offset w normal 1mm"}).find("straight"), std::string::npos);
}

// Reflects positions; the tool's x and z axes are the mirrored ones.
TEST(StrokeEdits, MirrorTwiceIsTheSame) {
  const DrawnPath path = sample_of_edits();
  const std::string edit = "mirror c 0,0.1,0 0,2,0";
  const DrawnPath once = edited(path, {edit}), twice = edited(path, {edit, edit});
  for (std::size_t p = 0; p < 5; ++p) {
    const Pose& before = path[2].points[p].pose;
    const Pose& after = once[2].points[p].pose;
    EXPECT_NEAR(after.translation.y(), 0.2 - before.translation.y(), 1e-15);
    EXPECT_EQ(after.translation.x(), before.translation.x());
    const Matrix3 was = before.rotation.toRotationMatrix(), is = after.rotation.toRotationMatrix();
    const Matrix3 reflect = Vector3(1, -1, 1).asDiagonal();
    EXPECT_LT((is.col(2) - reflect * was.col(2)).norm(), 1e-14);
    EXPECT_LT((is.col(0) - reflect * was.col(0)).norm(), 1e-14);
    EXPECT_NEAR(is.determinant(), 1, 1e-14);
    EXPECT_LT((twice[2].points[p].pose.translation - before.translation).norm(), 1e-15);
    EXPECT_LT((twice[2].points[p].covariance - path[2].points[p].covariance).norm(), 1e-15);
  }
}

// On the plane of the map's figures, which the robot sees turned; covariance by its definition.
TEST(StrokeEdits, ProjectOntoAPlaneOfTheMap) {
  const std::string file = path_beside_test("planes_of_a_map.json");
  std::ofstream(file) << "{\"planes\": [{\"normal\": [0, 0, 1], \"offset_m\": 0.5, "
                         "\"rms_mm\": 1, \"points\": 9}, {\"normal\": [0.6, 0, 0.8], "
                         "\"offset_m\": 0.25, \"rms_mm\": 2, \"points\": 9}]}";
  const Pose T_robot_map{Quaternion(Eigen::AngleAxisd(0.7, Vector3(1, 2, 2) / 3)), {0.1, 0.2, 0.3}};
  const auto planes = read_mapped_planes(file, T_robot_map);
  const DrawnPath path = sample_of_edits();
  const DrawnPath out = edited(path, {"project a 2"}, planes);
  const Vector3 normal = T_robot_map.rotation * Vector3(0.6, 0, 0.8);
  for (std::size_t p = 0; p < path[0].points.size(); ++p) {
    const UncertainPose &before = path[0].points[p], &after = out[0].points[p];
    const Vector3 in_map = T_robot_map.inverse() * after.pose.translation;
    EXPECT_NEAR(0.6 * in_map.x() + 0.8 * in_map.z(), 0.25, 1e-12);
    EXPECT_LT((after.pose.translation - before.pose.translation).cross(normal).norm(), 1e-12);
    const Matrix3 position = after.covariance.topLeftCorner<3, 3>();
    EXPECT_NEAR(normal.dot(position * normal), 4e-6, 1e-15);
    const Vector3 within = normal.unitOrthogonal();
    EXPECT_NEAR(within.dot(position * within),
                within.dot(before.covariance.topLeftCorner<3, 3>() * within), 1e-15);
  }
  EXPECT_THROW((void)edited(path, {"project a 3"}, planes), InputError);
  EXPECT_THROW((void)edited(path, {"project a 1"}), InputError);
  std::ofstream(file) << "{\"planes\": [{\"normal\": [0, 0, 2]}]}";
  EXPECT_THROW((void)read_mapped_planes(file, {}), InputError);
  EXPECT_THROW((void)read_mapped_planes("absent.json", {}), InputError);
}

TEST(StrokeEdits, ApproachAddsWaypointsAtBothEnds) {
  const DrawnPath path = sample_of_edits();
  const DrawnPath out = edited(path, {"approach b tool 5cm"});
  ASSERT_EQ(names_of(out), "a b.approach b b.retract c w ");
  const Pose &first = path[1].points.front().pose, &last = path[1].points.back().pose;
  EXPECT_LT((first.inverse() * out[1].points[0].pose.translation - Vector3(0, 0, 0.05)).norm(),
            1e-15);
  EXPECT_LT((last.inverse() * out[3].points[0].pose.translation - Vector3(0, 0, 0.05)).norm(),
            1e-15);
  EXPECT_EQ(out[1].kind, PathKind::waypoint);
  EXPECT_EQ(out[2].points[0].pose.translation, first.translation);
  EXPECT_NE(error_of({"approach b tool 5cm", "approach b tool 5cm"}).find("exists"),
            std::string::npos);
}

TEST(StrokeEdits, RefuseUnknownWordsNamesAndNumbers) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "no verb"},
      {"turn a", "found \"turn\"; expected delete"},
      {"delete", "no name"},
      {"delete d", "no element \"d\"; expected one of a, b, c, w"},
      {"delete a b", "found \"b\"; expected the end"},
      {"rename a b", "the name \"b\"; expected a new one"},
      {"rename a x/y", "the name \"x/y\""},
      {"replace a a", "an element replaces itself"},
      {"offset a 1,2 1mm", "expected three numbers"},
      {"offset a 1,2,3x 1mm", "expected three numbers"},
      {"offset a 1,nan,3 1mm", "expected three numbers"},
      {"offset a 0,0,0 1mm", "a direction of length 0"},
      {"offset a tool 1", "expected a length"},
      {"offset a tool 1inch", "expected a length"},
      {"offset a tool 11m", "expected a length"},
      {"mirror a 0,0,0", "no normal"},
  };
  for (const auto& [edit, expected] : cases) {
    const std::string error = error_of({edit});
    EXPECT_EQ(error.find(std::string("--edit \"") + edit + '"'), 0u) << error;
    EXPECT_NE(error.find(expected), std::string::npos) << error;
  }
  EXPECT_NE(error_of(std::vector<std::string>(1001, "rename a a")).find("1001"), std::string::npos);
}

TEST(StrokesJson, ReadsBackTheSameBits) {
  const StrokesFile strokes{sample_of_edits(), "pen \"1\"", Duration{1'700'000'000'000'000'001}};
  const StrokesFile back = strokes_of_json(strokes_json(strokes), "a.json");
  EXPECT_EQ(back.tool, strokes.tool);
  EXPECT_EQ(back.unix_offset, strokes.unix_offset);
  ASSERT_EQ(names_of(back.path), names_of(strokes.path));
  for (std::size_t e = 0; e < back.path.size(); ++e) {
    EXPECT_EQ(back.path[e].kind, strokes.path[e].kind);
    ASSERT_EQ(back.path[e].points.size(), strokes.path[e].points.size());
    for (std::size_t p = 0; p < back.path[e].points.size(); ++p) {
      const UncertainPose &a = back.path[e].points[p], &b = strokes.path[e].points[p];
      EXPECT_EQ(a.time, b.time);
      EXPECT_EQ(a.pose.translation, b.pose.translation);
      EXPECT_EQ(a.pose.rotation.coeffs(), b.pose.rotation.coeffs());
      EXPECT_EQ(a.covariance, 0.5 * (b.covariance + b.covariance.transpose()));
    }
  }
}

std::string example_of_the_page() {
  const std::string text = text_of(path_beside_test("strokes_file.md"));
  const std::size_t begin = text.find("```json\n") + 8;
  return text.substr(begin, text.find("```", begin) - begin);
}

TEST(StrokesJson, ReadsTheExampleOfItsPage) {
  const StrokesFile strokes = strokes_of_json(example_of_the_page(), "page");
  ASSERT_EQ(strokes.path.size(), 1u);
  EXPECT_EQ(strokes.path[0].name, "start");
  EXPECT_EQ(strokes.path[0].points[0].time, (Time{1'000'000'000}));
  EXPECT_EQ(strokes.path[0].points[0].covariance(5, 5), 1e-4);
}

TEST(StrokesJson, RefusesWithPlaceFoundAndExpected) {
  const std::string good = example_of_the_page();
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  const std::pair<std::string, const char*> cases[] = {
      {"no json", "f: byte 2: no JSON; expected a strokes file"},
      {with("\"version\": 1", "\"version\": 2"), "f.version: found 2; expected 1"},
      {with("glint_strokes", "strokes"), "f.format: found \"strokes\"; expected glint_strokes"},
      {with("\"robot\"", "\"world\""), "f.frame: found \"world\"; expected robot"},
      {with("\"tool\": \"pen\",", ""), "f: no key \"tool\"; expected format, version"},
      {with("\"tool\"", "\"tool\": \"x\", \"tool\""), "f: duplicate key \"tool\""},
      {with("\"tool\"", "\"speed\": 1, \"tool\""), "f: unknown key \"speed\"; expected one of"},
      {with("\"kind\"", "\"colour\": 1, \"kind\""),
       "f.elements[0]: unknown key \"colour\"; expected one of name, kind, points"},
      {with("\"waypoint\"", "\"stroke\""), "f.elements[0].points: found "},
      {with("\"start\"", "\"a b\""), "f.elements[0].name: found \"a b\"; expected at most 64"},
      {with("[0.4, 0.1, 0.2]", "[0.4, 0.1]"),
       "f.elements[0].points[0].position_m: found [0.4,0.1]; expected 3 numbers"},
      {with("0.4", "\"0.4\""), "position_m[0]: found \"0.4\"; expected a number"},
      {with("0.4", "1e999"), "f: a number out of range"},
      {with("[0, 0, 0, 1]", "[0, 0, 1, 1]"), "expected a unit quaternion"},
      {with("1e-4]", "-1e-4]"), "expected a symmetric matrix"},
      {with("[1e-6,0", "[1e-6,1e-7"), "expected a symmetric matrix"},
      {with("1000000000", "1.5"), "points[0].time_ns: found 1.5; expected whole nanoseconds"},
      {with("1000000000", "9000000000000000000"), "expected whole nanoseconds"},
  };
  for (const auto& [text, expected] : cases) {
    try {
      (void)strokes_of_json(text, "f");
      ADD_FAILURE() << expected;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what() << "\n"
                                                                             << expected;
    }
  }
  EXPECT_THROW((void)read_strokes("absent.json"), InputError);
}

}  // namespace
}  // namespace glint
