// Experiments on points: Cramer-Rao bound against closed forms, scenes against ground truth, and
// the required limits with the device's real lens.
#include "platform/lab/experiments/bound_experiment.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>

#include "platform/lab/experiments/cramer_rao.hpp"
#include "platform/lab/experiments/noise_experiment.hpp"
#include "platform/lab/experiments/point_view.hpp"

namespace glint {
namespace {

Camera pinhole() {
  Camera camera = hololens2_ahat();
  camera.model = CameraModel{};
  camera.model.width = camera.model.height = 512;
  camera.model.fx = camera.model.fy = 253;
  camera.model.cx = camera.model.cy = 256;
  return camera;
}

// A distant square, perpendicular to the optical axis: no perspective, and by symmetry no coupling.
TEST(CramerRao, OfASquareSeenStraightOnIsWhatItsGeometrySays) {
  Tool square;
  square.marker_count = 4;
  square.markers_m = {Vector3(0.05, 0, 0), Vector3(0, 0.05, 0), Vector3(-0.05, 0, 0),
                      Vector3(0, -0.05, 0)};
  const Pose pose{Quaternion::Identity(), Vector3(0, 0, 20)};
  const ObservationNoise noise{0.001 * 253 / 20, 0.002};
  const Matrix6 bound = cramer_rao_bound(pinhole(), square, pose, Vector3::Zero(), noise);
  const double s = 1e-6;
  const double expected[6] = {s / 4, s / 4, s, 4 * s / 0.005, 4 * s / 0.005, s / 0.01};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(bound(i, i) / expected[i], 1, 0.01) << i;
}

TEST(CramerRao, IsTheSameThroughATableOfRaysAsThroughTheLensItself) {
  const PointTool ndi = ndi_8700339();
  const Camera table = ahat_ray_table(), lens = hololens2_ahat();
  for (std::uint64_t sample = 0; sample < 20; ++sample) {
    SampleNumbers numbers(1, 0, sample);
    const Pose pose = draw_pose(ndi, 0.5, 0.6, numbers).T_camera_tool;
    const Matrix6 a = cramer_rao_bound(table, ndi.tool, pose, ndi.tool.tip_m, {});
    const Matrix6 b = cramer_rao_bound(lens, ndi.tool, pose, ndi.tool.tip_m, {});
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(a(i, i) / b(i, i), 1, 0.01);
  }
}

TEST(PointView, DrawsPosesAtTheirTiltAndTheirMirrorImages) {
  const PointTool ndi = ndi_8700339();
  const Vector3 mean = marker_mean(ndi.tool);
  for (std::uint64_t sample = 0; sample < 50; ++sample) {
    SampleNumbers numbers(1, 0, sample);
    const DrawnPose drawn = draw_pose(ndi, 0.5, 0.4, numbers);
    const Vector3 sight = (drawn.T_camera_tool * mean).normalized();
    EXPECT_NEAR((drawn.T_camera_tool * mean).norm(), 0.5, 1e-12);
    EXPECT_NEAR((drawn.T_camera_tool.rotation * ndi.normal).dot(-sight), std::cos(0.4), 1e-9);
    EXPECT_NEAR((drawn.T_camera_mirrored.rotation * ndi.normal).dot(-sight), std::cos(0.4), 1e-9);
    EXPECT_NEAR(rotation_between_rad(drawn.T_camera_tool, drawn.T_camera_mirrored), 0.8, 1e-9);
  }
}

TEST(PointView, KeepsTheTruthWhileItShuffles) {
  const PointTool pen = five_marker_pen();
  const Camera camera = ahat_ray_table();
  PointView view;
  for (std::uint64_t sample = 0; sample < 20; ++sample) {
    SampleNumbers numbers(1, 0, sample);
    const Pose pose = draw_pose(pen, 0.5, 0.4, numbers).T_camera_tool;
    view.clear();
    for (int i = 0; i < 5; ++i) {
      const Vector3 centre = pose * pen.tool.markers_m[static_cast<std::size_t>(i)];
      ASSERT_TRUE(view.add(camera, pen.tool, centre, i, {0, 0}, numbers));
    }
    ASSERT_TRUE(view.add(camera, pen.tool, Vector3(0, 0, 0.4), -1, {0, 0}, numbers));
    view.shuffle(numbers);
    for (std::size_t i = 0; i < 5; ++i) {
      const auto at = static_cast<std::size_t>(view.truth[i]);
      const Marker& seen = view.markers.items[at];
      const Vector3 centre = seen.ray * (seen.surface_range_m + pen.tool.centre_offset_m());
      EXPECT_LT((centre - pose * pen.tool.markers_m[i]).norm(), 1e-6);
      EXPECT_EQ(view.sights[at].rays.ray, seen.ray);
    }
  }
}

const Figure& figure_of(const ExperimentCase& c, const std::string& name) {
  for (const Figure& figure : c.figures) {
    if (figure.name == name) return figure;
  }
  ADD_FAILURE() << "no " << name << " in " << c.name;
  return c.figures.front();
}

TEST(BoundExperiment, HoldsOnlyGlintToBarsAndNoneInAQuickRun) {
  CaseOptions options;
  options.quick = true;
  const CaseList list = run_bound(options);
  std::set<std::string> methods;
  for (const ExperimentCase& c : list.cases) {
    methods.insert(c.method);
    EXPECT_GT(c.n, 0);
    for (const Figure& figure : c.figures) EXPECT_EQ(figure.bar.kind, Bar::Kind::none);
    if (c.method != "svd") continue;
    EXPECT_GT(figure_of(c, "rotation_above_bound").value, 0.9);
  }
  EXPECT_EQ(methods, (std::set<std::string>{"glint", "svd", "baseline"}));
}

TEST(BoundExperiment, GivesTheSameFiguresAgain) {
  CaseOptions options;
  options.quick = true;
  const std::string first = case_json(run_noise(options), options);
  EXPECT_EQ(case_json(run_noise(options), options), first);
  options.seed = 2;
  EXPECT_NE(case_json(run_noise(options), options), first);
}

TEST(BoundExperiment, ReachesTheBoundThroughARealDevicesTableOfRays) {
  const char* data = std::getenv("GLINT_TEST_DATA");
  const std::string path = std::string(data == nullptr ? "" : data) +
                           "/hololens2_ahat_lut/ahat_lut_512x512x3_float32.npy";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path << "; set GLINT_TEST_DATA";
  const Camera camera = with_ray_table(hololens2_ahat(), path);
  for (const ExperimentCase& c : bound_cases_at(camera, 0.5, 4000, 1)) {
    if (c.method != "glint") continue;
    for (const char* name : {"position_above_bound", "tip_above_bound", "rotation_above_bound"})
      EXPECT_LE(figure_of(c, name).value, 1.05) << c.name << " " << name;
    EXPECT_LE(figure_of(c, "nees_off_one").value, 0.1) << c.name;
  }
}

}  // namespace
}  // namespace glint
