#include "kernels/pose/systematic_covariance.hpp"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <vector>

#include "kernels/motion/motion_state.hpp"
#include "kernels/pose/weighted_fit.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::systematic_covariance_test {
namespace {

using test::Random;

constexpr MarkerVariance k_variance{0.01, 0.002, 0.012, 0.0015 * 0.0015};

// Pixel, range and model position of one marker as the tracker uses them.
struct Observation {
  Vector2 pixel;
  double range_m = 0;
  Vector3 model_m;
};
using Error = std::function<void(std::size_t marker, Observation& observation)>;

struct Scene {
  Tool tool;
  Pose pose;
  std::vector<WeightedMarker> markers;
  std::vector<LocalRays> rays;

  Scene(const Tool& of, const Pose& at, const Error& error,
        const CameraModel& camera = test::pinhole())
      : tool(of), pose(at) {
    for (int i = 0; i < tool.marker_count; ++i) {
      const auto m = static_cast<std::size_t>(i);
      const Vector3 point = pose * tool.markers_m[m];
      Observation observation{project(camera, point).value, point.norm(), tool.markers_m[m]};
      if (error) error(m, observation);
      int steps = 0;
      rays.push_back(local_rays(camera, observation.pixel, k_ray_steps_max, steps).value);
      markers.push_back(
          whiten_marker(observation.model_m, rays.back(), observation.range_m, k_variance).value);
    }
  }
  [[nodiscard]] Pose fitted() const {
    return fit_weighted(markers, mean_of(markers), pose, nullptr, k_refine_steps_max).T_camera_tool;
  }
};

// Change of the fitted pose by the error: reference point, and rotation about the camera's axes.
Vector6 moved_by(const Tool& tool, const Pose& pose, const Vector3& reference_m, const Error& error,
                 const CameraModel& camera = test::pinhole()) {
  const Pose found = Scene(tool, pose, error, camera).fitted();
  Vector6 moved;
  moved << found * reference_m - pose * reference_m,
      rotation_vector(found.rotation * pose.rotation.conjugate());
  return moved;
}

// The same sum by refits. Each parameter is off by a hundredth of its standard deviation, which
// keeps the fit linear.
Matrix6 by_refits(const Tool& tool, const Pose& pose, const Vector3& reference_m,
                  const CameraUncertainty& camera, double marker_sigma_m) {
  constexpr double k_share = 0.01;
  Matrix6 sum = Matrix6::Zero();
  const auto add = [&](const Error& error) {
    const Vector6 moved = moved_by(tool, pose, reference_m, error) / k_share;
    sum += moved * moved.transpose();
  };
  const Vector2 principal(256, 256);
  add([&](std::size_t, Observation& t) { t.range_m += k_share * camera.range_offset_m; });
  add([&](std::size_t, Observation& t) { t.range_m *= 1 + k_share * camera.range_scale; });
  add([&](std::size_t, Observation& t) {
    t.pixel += k_share * camera.focal_scale * (t.pixel - principal);
  });
  for (int axis = 0; axis < 2; ++axis)
    add([&](std::size_t, Observation& t) { t.pixel[axis] += k_share * camera.principal_point_px; });
  for (std::size_t m = 0; m < static_cast<std::size_t>(tool.marker_count); ++m) {
    const auto add_own = [&](const std::function<void(Observation&)>& error) {
      add([&](std::size_t i, Observation& t) {
        if (i == m) error(t);
      });
    };
    add_own([&](Observation& t) { t.range_m += k_share * camera.correlated_range_m; });
    for (int axis = 0; axis < 2; ++axis)
      add_own([&](Observation& t) { t.pixel[axis] += k_share * camera.correlated_centroid_px; });
    for (int axis = 0; axis < 3; ++axis)
      add_own([&](Observation& t) { t.model_m[axis] += k_share * marker_sigma_m; });
  }
  return sum;
}

struct View {
  Tool tool;
  Pose pose;
};

std::vector<View> views() {
  std::vector<View> all;
  Random random(17);
  for (int i = 0; i < 12; ++i) {
    const Tool tool = i % 3 == 0 ? test::flat_tool() : test::random_tool(random, 3 + i % 5);
    const double x = random.within(-0.25, 0.25), y = random.within(-0.25, 0.25);
    const Vector3 place(x, y, random.within(0.35, 0.7));
    const double tilt_rad = random.within(0.4, 1.2);
    all.push_back({tool, test::tilted_pose(tool, tilt_rad, place, random)});
  }
  return all;
}

void expect_near(const Matrix6& found, const Matrix6& expected, double share) {
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const double scale = std::sqrt(expected(i, i) * expected(j, j));
      EXPECT_NEAR(found(i, j), expected(i, j), share * scale) << i << " " << j;
    }
  }
}

TEST(SystematicCovariance, IsTheSumOverRefitsWithEachParameterOff) {
  const Vector3 reference_m(0.01, -0.02, 0.15);
  for (const View& view : views()) {
    const Scene exact(view.tool, view.pose, nullptr);
    const auto found = systematic_covariance(exact.markers, exact.rays, view.pose, reference_m,
                                             CameraUncertainty{}, 0.0003);
    ASSERT_EQ(found.reason, Reason::none);
    expect_near(found.value.calibration + found.value.correlated.sum(),
                by_refits(view.tool, view.pose, reference_m, CameraUncertainty{}, 0.0003), 0.03);
  }
}

// One parameter at a time, so that a larger one cannot hide it.
TEST(SystematicCovariance, HasEachParametersShare) {
  const Vector3 reference_m(0, 0, 0.1);
  const std::array<CameraUncertainty, 6> alone = {{{0.006, 0, 0, 0, 0, 0, 0, 0},
                                                   {0, 0.01, 0, 0, 0, 0, 0, 0},
                                                   {0, 0, 3, 0, 0, 0, 0, 0},
                                                   {0, 0, 0, 0.003, 0, 0, 0, 0},
                                                   {0, 0, 0, 0, 0.0007, 0, 0.25, 0},
                                                   {0, 0, 0, 0, 0, 0.05, 0.25, 0}}};
  const View view = views()[4];
  const Scene exact(view.tool, view.pose, nullptr);
  const auto expect_share = [&](const CameraUncertainty& camera, double marker_sigma_m) {
    const auto found = systematic_covariance(exact.markers, exact.rays, view.pose, reference_m,
                                             camera, marker_sigma_m);
    const Matrix6 expected = by_refits(view.tool, view.pose, reference_m, camera, marker_sigma_m);
    EXPECT_GT(expected.trace(), 0);
    const bool slow = camera.correlated_range_m + camera.correlated_centroid_px > 0;
    expect_near(slow ? found.value.correlated.sum() : found.value.calibration, expected, 0.03);
    EXPECT_TRUE((slow ? found.value.calibration : found.value.correlated.sum()).isZero());
    EXPECT_TRUE(found.value.correlated.fast.isApprox(0.25 * found.value.correlated.sum()));
  };
  for (const CameraUncertainty& camera : alone) expect_share(camera, 0);
  expect_share(k_exact_camera, 0.0003);
}

// At a tangent of 0.5 off the axis, a pixel of this lens rotates the ray a sixth more than a
// pinhole's.
TEST(SystematicCovariance, FocalLengthActsAsTheLensDistorts) {
  CameraModel camera = test::pinhole();
  camera.lens = Lens::rational;
  camera.distortion = {0.48, 0.19, 0, 0, 0.014, 0.82, 0.29, 0.062};
  Random random(5);
  const Tool tool = test::random_tool(random, 5);
  const Pose pose = test::tilted_pose(tool, 0.7, {0.3, -0.1, 0.5}, random);
  constexpr double k_scale = 0.0001;
  const Vector2 principal(256, 256);
  const Error longer = [&](std::size_t, Observation& t) {
    t.pixel += k_scale * (t.pixel - principal);
  };
  const Vector6 moved = moved_by(tool, pose, Vector3::Zero(), longer, camera);
  const Scene exact(tool, pose, nullptr, camera);
  CameraUncertainty alone = k_exact_camera;
  alone.focal_scale = k_scale;
  const auto found =
      systematic_covariance(exact.markers, exact.rays, pose, Vector3::Zero(), alone, 0);
  ASSERT_EQ(found.reason, Reason::none);
  expect_near(found.value.calibration, moved * moved.transpose(), 0.03);
}

TEST(SystematicCovariance, IsZeroWithoutUncertaintyAndStatesWhyThereIsNone) {
  const View view = views().front();
  const Scene exact(view.tool, view.pose, nullptr);
  const auto none =
      systematic_covariance(exact.markers, exact.rays, view.pose, {}, k_exact_camera, 0);
  EXPECT_EQ(none.reason, Reason::none);
  EXPECT_TRUE(none.value.calibration.isZero());
  EXPECT_TRUE(none.value.correlated.sum().isZero());
  const std::span<const WeightedMarker> one(exact.markers.data(), 1);
  const std::span<const LocalRays> its_rays(exact.rays.data(), 1);
  EXPECT_EQ(systematic_covariance(one, its_rays, view.pose, {}, {}, 0).reason, Reason::degenerate);
  EXPECT_EQ(systematic_covariance({}, {}, view.pose, {}, {}, 0).reason, Reason::degenerate);
  EXPECT_EQ(systematic_covariance(exact.markers, its_rays, view.pose, {}, {}, 0).reason,
            Reason::degenerate);
}

TEST(SystematicCovariance, GivesTheSameBitsEverywhere) {
  test::BitHash hash;
  for (const View& view : views()) {
    const Scene exact(view.tool, view.pose, nullptr);
    const SystematicCovariance found =
        systematic_covariance(exact.markers, exact.rays, view.pose, {0, 0, 0.1},
                              CameraUncertainty{}, 0.0003)
            .value;
    for (int i = 0; i < 36; ++i) {
      hash.add(found.calibration(i / 6, i % 6));
      hash.add(found.correlated.slow(i / 6, i % 6));
    }
  }
  EXPECT_EQ(hash.value(), 11536243864945107149u);
}

}  // namespace
}  // namespace glint::systematic_covariance_test
