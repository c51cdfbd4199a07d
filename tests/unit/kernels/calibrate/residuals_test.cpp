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

// A body with constant velocity and constant angular rate about z, around t = 1 s.
MotionSegment even_piece() {
  MotionSegment piece;
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
  const PoseOf<double> pose = interpolated_pose<double>(even_piece(), 1.004);
  EXPECT_LT((pose.translation - (k_point + Vector3(1, 2, -1) * 0.004)).norm(), 1e-15);
  EXPECT_LT(pose.rotation.angularDistance(from_rotation_vector({0, 0, 0.004})), 8e-8);
  EXPECT_NEAR(pose.rotation.norm(), 1, 1e-15);
}

TEST(Residuals, FollowAParabolaThroughUnevenSamples) {
  MotionSegment piece = even_piece();
  const double seconds[] = {0.0, 0.3, 0.5, 1.1};
  const auto place = [](double t) { return Vector3(t * t, 1 - 2 * t * t, t); };
  for (int i = 0; i < 4; ++i) {
    piece.seconds[i] = seconds[i];
    piece.position_m[i] = place(seconds[i]);
  }
  for (const double t : {0.3, 0.37, 0.5}) {
    EXPECT_LT((interpolated_pose<double>(piece, t).translation - place(t)).norm(), 1e-15) << t;
  }
}

TEST(Residuals, AlignTwoTrackersThroughFrameLeverArmAndOffset) {
  const PoseOf<double> x{k_turn, {1, 0, 2}}, y{k_turn.conjugate(), {0, 0.1, 0}};
  const PoseOf<double> seen = interpolated_pose<double>(even_piece(), 1.002);
  const Pose body{seen.rotation, seen.translation};
  const Pose T_x{x.rotation, x.translation}, T_y{y.rotation, y.translation};
  AlignSample sample{0.9, T_x.inverse() * body * T_y.inverse(), even_piece(), 0.001, 0.01};
  AlignResidual<double> residual = align_residual<double>(sample, x, y, 0.102);
  EXPECT_LT(residual.position.norm() + residual.rotation.norm(), 1e-10);
  residual = align_residual<double>(sample, x, y, 0.103);  // 1 ms later
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
  sample.inverse_signal = 0.5;
  sample.sigma_x_px = 0.1;
  sample.sigma_y_px = 0.2;
  sample.sigma_range_m = 0.002;
  const Vector3 at(0.02, -0.03, 0.6);
  const Vector3 centre = k_turn * k_point + at, bias(0.004, -0.01, 0.002);
  sample.ray = centre.normalized();
  sample.per_x = 250 * sample.ray.unitOrthogonal();
  sample.per_y = 250 * sample.ray.cross(sample.ray.unitOrthogonal());
  const double surface = centre.norm() - 0.006;
  double stated = surface;  // fixed-point iteration of range = surface + bias(range)
  for (int i = 0; i < 20; ++i) {
    stated = surface + DepthBias{bias[0], bias[1], bias[2], 0.01, 10}.at(stated, 2000);
  }
  sample.surface_range_m = stated;
  EXPECT_LT(depth_residual<double>(sample, k_turn, at, bias).norm(), 1e-9);
  sample.surface_range_m = stated + 0.002;
  EXPECT_NEAR(depth_residual<double>(sample, k_turn, at, bias).z(), -1, 1e-9);
  const Vector3 aside = at + 0.001 * sample.per_y / 250;  // 1 mm across the ray
  EXPECT_NEAR(depth_residual<double>(sample, k_turn, aside, bias).y(), 0.25 / centre.norm() / 0.2,
              1e-6);
}

// Each component is divided by its own standard deviation, along each axis; the sign is model minus
// measurement.
TEST(Residuals, AreModelLessMeasurementInSigmasAlongEachAxis) {
  const Vector3 off(0.003, -0.002, 0.001), lever(0.01, 0.02, -0.15), post(1, 2, 3);
  const Quaternion turned = from_rotation_vector({0.01, -0.02, 0.03});
  const PivotSample sample{k_turn, post - k_turn * turned * lever + off, 0.02, 0.004};
  const PivotResidual<double> pivot = pivot_residual<double>(sample, k_turn * turned, lever, post);
  EXPECT_LT((pivot.position - off / 0.004).norm(), 1e-12);
  EXPECT_LT((pivot.rotation - 2 * turned.vec() / 0.02).norm(), 1e-12);
  EXPECT_LT((marker_residual<double>(k_turn * k_point + post - off, 0.004, k_turn, post, k_point) -
             off / 0.004)
                .norm(),
            1e-12);
  EXPECT_LT((axis_residual<double>(k_turn, k_point, k_turn * k_point - off) - off).norm(), 1e-15);
}

TEST(Residuals, AlignARotationByItsSigmaWhicheverOfItsQuaternionsStandsForIt) {
  const PoseOf<double> x{k_turn, {1, 0, 2}}, y{from_rotation_vector({0.2, 0.1, -0.4}), {0, 0.1, 0}};
  const PoseOf<double> seen = interpolated_pose<double>(even_piece(), 1.002);
  const Quaternion off = from_rotation_vector({0.01, -0.02, 0.03});
  const Vector3 shift(0.003, -0.002, 0.001);
  // The reference's orientation differs from the body's by `off`, in the body's frame.
  const Pose T_x{x.rotation, x.translation}, T_y{y.rotation, y.translation};
  const Pose body{(seen.rotation * off.conjugate()).normalized(), seen.translation + shift};
  AlignSample sample{0.9, T_x.inverse() * body * T_y.inverse(), even_piece(), 0.004, 0.02};
  for (int sign = 0; sign < 2; ++sign) {
    const AlignResidual<double> residual = align_residual<double>(sample, x, y, 0.102);
    EXPECT_LT((residual.position - shift / 0.004).norm(), 1e-9);
    EXPECT_LT((residual.rotation - 2 * off.vec() / 0.02).norm(), 1e-9);
    sample.pose.rotation.coeffs() *= -1;
  }
}

// Marker pixel minus measured pixel, along both axes of the image.
TEST(Residuals, StateAPixelAcrossTheRayByItsSigmas) {
  DepthSample sample;
  sample.marker_m = k_point;
  sample.sigma_x_px = 0.1;
  sample.sigma_y_px = 0.25;
  const Vector3 at(0.02, -0.03, 0.6), centre = k_turn * k_point + at;
  const Vector3 right = centre.unitOrthogonal(), down = centre.normalized().cross(right);
  sample.ray = centre.normalized();
  sample.per_x = 250 * right;
  sample.per_y = 400 * down;
  sample.surface_range_m = centre.norm();
  const Vector3 moved = at + 0.001 * right - 0.002 * down;
  const Vector3 found = depth_residual<double>(sample, k_turn, moved, Vector3::Zero());
  EXPECT_NEAR(found.x(), 250 * 0.001 / centre.norm() / 0.1, 1e-9);
  EXPECT_NEAR(found.y(), 400 * -0.002 / centre.norm() / 0.25, 1e-9);
}

TEST(Residuals, ProjectAsTheBrownLensDoesAndMissByAPixelsDistance) {
  CameraModel camera;
  camera.lens = Lens::brown;
  camera.fx = 253, camera.fy = 257, camera.cx = 258, camera.cy = 244.5;
  camera.distortion = {-0.2, 0.05, 0.0008, -0.0011, 0.01, 0, 0, 0};
  double lens[k_lens_numbers] = {camera.fx, camera.fy, camera.cx, camera.cy};
  for (std::size_t i = 0; i < 8; ++i) lens[4 + i] = camera.distortion[i];
  for (const Vector2& plane : {Vector2(0, 0), Vector2(0.3, -0.4), Vector2(-0.5, 0.6)}) {
    const Vector2 pixel = project(camera, {plane.x(), plane.y(), 1}).value;
    const Vector2 miss = lens_residual<double>(plane, pixel - Vector2(1.5, -2.5), lens);
    EXPECT_LT((miss - Vector2(1.5, -2.5)).norm(), 1e-9);
  }
}

TEST(Residuals, StayFiniteAtTheirWorst) {
  // No translation, no rotation, all samples at one position.
  MotionSegment piece = even_piece();
  for (Vector3& position : piece.position_m) position.setZero();
  piece.rotation[0] = piece.rotation[1] = Quaternion::Identity();
  const PoseOf<double> pose = interpolated_pose<double>(piece, 5.0);  // far outside its samples
  EXPECT_TRUE(pose.translation.allFinite());
  EXPECT_TRUE(pose.rotation.coeffs().allFinite());
  EXPECT_TRUE(pivot_residual<double>({}, Quaternion(0, 1, 0, 0), Vector3::Zero(), Vector3::Zero())
                  .rotation.allFinite());
}

std::uint64_t fnv1a_of(std::uint64_t hash, const Vector3& v) {
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
    hash = fnv1a_of(fnv1a_of(hash, pivot.position), pivot.rotation);
    hash = fnv1a_of(hash, axis_residual<double>(q, v, k_point));
    hash = fnv1a_of(hash, marker_residual<double>(v, 0.003, q, k_point, v));
    const AlignResidual<double> align = align_residual<double>(
        {0.9, {q, v}, even_piece(), 0.01, 0.02}, {k_turn, v}, {q, k_point}, 0.1 + 1e-5 * i);
    hash = fnv1a_of(fnv1a_of(hash, align.position), align.rotation);
  }
  EXPECT_EQ(hash, 935719419659854628u);  // g++ -O3, clang++ -O1 and -O3
}

}  // namespace
}  // namespace glint
