#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "kernels/calibrate/align_residual.hpp"
#include "kernels/calibrate/axis_residual.hpp"
#include "kernels/calibrate/depth_residual.hpp"
#include "kernels/calibrate/lens_residual.hpp"
#include "kernels/calibrate/marker_residual.hpp"
#include "kernels/calibrate/pivot_residual.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/camera_model.hpp"

namespace glint {
namespace {

using Extended = long double;

const Quaternion k_turn = from_rotation_vector({0.3, -0.7, 1.1});
const Vector3 k_point(0.1, -0.2, 0.3);

// A body that shifts evenly and turns evenly about z, around second 1.
MotionPiece even_piece() {
  MotionPiece piece;
  for (int i = 0; i < 4; ++i) {
    piece.seconds[i] = 0.97 + 0.02 * i;
    piece.position_m[i] = k_point + Vector3(1, 2, -1) * (piece.seconds[i] - 1);
  }
  piece.rotation[0] = from_rotation_vector({0, 0, -0.01});
  piece.rotation[1] = from_rotation_vector({0, 0, 0.01});
  return piece;
}

TEST(Residuals, RotateAsAQuaternionDoes) {
  EXPECT_LT((rotated<double>(k_turn, k_point) - k_turn * k_point).norm(), 1e-16);
  const Vector3Of<Extended> more =
      rotated<Extended>(k_turn.cast<Extended>(), k_point.cast<Extended>());
  EXPECT_LT((more.cast<double>() - k_turn * k_point).norm(), 1e-15);
}

TEST(Residuals, AreZeroAtTheTruth) {
  const Vector3 lever(0, 0.01, -0.15), post(1, 2, 3);
  const PivotSample sample{k_turn, post - k_turn * lever, 0.01, 0.001};
  const PivotResidual<double> pivot = pivot_residual<double>(sample, k_turn, lever, post);
  EXPECT_LT(pivot.position.norm() + pivot.rotation.norm(), 1e-12);
  EXPECT_LT(axis_residual<double>(k_turn, k_point, k_turn * k_point).norm(), 1e-15);
  EXPECT_LT(marker_residual<double>(k_turn * k_point + post, 1, k_turn, post, k_point).norm(),
            1e-15);
}

TEST(Residuals, SayHowManySigmasSomethingIsOff) {
  const PivotSample sample{Quaternion::Identity(), {0, 0, 0.002}, 0.01, 0.001};
  const Quaternion off = from_rotation_vector({0.02, 0, 0});
  const PivotResidual<double> pivot =
      pivot_residual<double>(sample, off, Vector3::Zero(), Vector3::Zero());
  EXPECT_NEAR(pivot.position.z(), 2, 1e-12);
  EXPECT_NEAR(pivot.rotation.x(), 2, 1e-4);
  const Quaternion other(-off.w(), -off.x(), -off.y(), -off.z());  // the same rotation
  EXPECT_EQ(pivot_residual<double>(sample, other, Vector3::Zero(), Vector3::Zero()).rotation,
            pivot.rotation);
}

TEST(Residuals, FollowAMotionBetweenItsSamples) {
  const PoseOf<double> pose = blended_pose<double>(even_piece(), 1.004);
  EXPECT_LT((pose.translation - (k_point + Vector3(1, 2, -1) * 0.004)).norm(), 1e-15);
  EXPECT_LT(pose.rotation.angularDistance(from_rotation_vector({0, 0, 0.004})), 8e-8);
  EXPECT_NEAR(pose.rotation.norm(), 1, 1e-15);
}

TEST(Residuals, FollowAParabolaThroughUnevenSamples) {
  MotionPiece piece = even_piece();
  const double seconds[] = {0.0, 0.3, 0.5, 1.1};
  const auto place = [](double t) { return Vector3(t * t, 1 - 2 * t * t, t); };
  for (int i = 0; i < 4; ++i) {
    piece.seconds[i] = seconds[i];
    piece.position_m[i] = place(seconds[i]);
  }
  for (const double t : {0.3, 0.37, 0.5}) {
    EXPECT_LT((blended_pose<double>(piece, t).translation - place(t)).norm(), 1e-15) << t;
  }
}

TEST(Residuals, AlignTwoTrackersThroughFrameLeverArmAndOffset) {
  const PoseOf<double> x{k_turn, {1, 0, 2}}, y{k_turn.conjugate(), {0, 0.1, 0}};
  const PoseOf<double> seen = blended_pose<double>(even_piece(), 1.002);
  const Pose body{seen.rotation, seen.translation};
  const Pose T_x{x.rotation, x.translation}, T_y{y.rotation, y.translation};
  AlignSample sample{0.9, T_x.inverse() * body * T_y.inverse(), even_piece(), 0.001, 0.01};
  AlignResidual<double> residual = align_residual<double>(sample, x, y, 0.102);
  EXPECT_LT(residual.position.norm() + residual.rotation.norm(), 1e-10);
  residual = align_residual<double>(sample, x, y, 0.103);  // a millisecond later
  EXPECT_NEAR(residual.position.x(), -1, 1e-9);
  EXPECT_NEAR(residual.position.y(), -2, 1e-9);
}

TEST(Residuals, ProjectAsTheRationalLensDoes) {
  CameraModel camera;
  camera.lens = Lens::rational;
  camera.fx = 253;
  camera.fy = 254;
  camera.cx = 258;
  camera.cy = 254.5;
  camera.distortion = {0.48, 0.19, 0.0008, -0.0001, 0.0138, 0.815, 0.289, 0.062};
  double lens[k_lens_numbers] = {camera.fx, camera.fy, camera.cx, camera.cy};
  for (std::size_t i = 0; i < 8; ++i) lens[4 + i] = camera.distortion[i];
  for (const Vector2& plane : {Vector2(0, 0), Vector2(0.3, -0.4), Vector2(-1.2, 1.0)}) {
    const Vector2 pixel = project(camera, {plane.x(), plane.y(), 1}).value;
    EXPECT_LT(lens_residual<double>(plane, pixel, lens).norm(), 1e-9);
  }
}

TEST(Residuals, StateARangeAsASensorWithABiasDoes) {
  DepthSample sample;
  sample.marker_m = k_point;
  sample.centre_behind_m = 0.006;
  sample.dimness = 0.5;
  sample.sigma_x_px = 0.1;
  sample.sigma_y_px = 0.2;
  sample.sigma_range_m = 0.002;
  const Vector3 at(0.02, -0.03, 0.6);
  const Vector3 centre = k_turn * k_point + at, bias(0.004, -0.01, 0.002);
  sample.ray = centre.normalized();
  sample.per_x = 250 * sample.ray.unitOrthogonal();
  sample.per_y = 250 * sample.ray.cross(sample.ray.unitOrthogonal());
  const double surface = centre.norm() - 0.006;
  double stated = surface;  // range = surface + bias(range), step by step
  for (int i = 0; i < 20; ++i) {
    stated = surface + DepthBias{bias[0], bias[1], bias[2], 0.01, 10}.at(stated, 2000);
  }
  sample.surface_range_m = stated;
  EXPECT_LT(depth_residual<double>(sample, k_turn, at, bias).norm(), 1e-9);
  sample.surface_range_m = stated + 0.002;
  EXPECT_NEAR(depth_residual<double>(sample, k_turn, at, bias).z(), -1, 1e-9);
  const Vector3 aside = at + 0.001 * sample.per_y / 250;  // a millimetre across the ray
  EXPECT_NEAR(depth_residual<double>(sample, k_turn, aside, bias).y(), 0.25 / centre.norm() / 0.2,
              1e-6);
}

TEST(Residuals, StayFiniteAtTheirWorst) {
  // Nothing moved, nothing turned, all in one place.
  MotionPiece piece = even_piece();
  for (Vector3& position : piece.position_m) position.setZero();
  piece.rotation[0] = piece.rotation[1] = Quaternion::Identity();
  const PoseOf<double> pose = blended_pose<double>(piece, 5.0);  // far beyond its samples
  EXPECT_TRUE(pose.translation.allFinite());
  EXPECT_TRUE(pose.rotation.coeffs().allFinite());
  EXPECT_TRUE(pivot_residual<double>({}, Quaternion(0, 1, 0, 0), Vector3::Zero(), Vector3::Zero())
                  .rotation.allFinite());
}

std::uint64_t mixed(std::uint64_t hash, const Vector3& v) {
  for (int axis = 0; axis < 3; ++axis) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(v[axis])) * 0x100000001b3u;
  }
  return hash;
}

TEST(Residuals, KeepTheirBits) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (int i = 0; i < 200; ++i) {
    const Vector3 v(0.01 * i, 1 - 0.007 * i, 0.3 + 0.002 * i);
    const Quaternion q = from_rotation_vector(v);
    const PivotResidual<double> pivot =
        pivot_residual<double>({q, v, 0.01, 0.002}, k_turn, v, k_point);
    hash = mixed(mixed(hash, pivot.position), pivot.rotation);
    hash = mixed(hash, axis_residual<double>(q, v, k_point));
    hash = mixed(hash, marker_residual<double>(v, 0.003, q, k_point, v));
    const AlignResidual<double> align = align_residual<double>(
        {0.9, {q, v}, even_piece(), 0.01, 0.02}, {k_turn, v}, {q, k_point}, 0.1 + 1e-5 * i);
    hash = mixed(mixed(hash, align.position), align.rotation);
  }
  EXPECT_EQ(hash, 935719419659854628u);  // g++ -O3, clang++ -O1 and -O3
}

}  // namespace
}  // namespace glint
