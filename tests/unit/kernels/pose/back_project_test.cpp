#include "kernels/pose/back_project.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "kernels/image/blobs.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "platform/formats/camera.hpp"
#include "platform/formats/frame_buffer.hpp"

namespace glint {
namespace {

constexpr double k_wall_m = 0.9;

// One sphere (radius > 0) or a disc that faces the camera, in front of a wall; 4 x 4 rays per
// pixel. Depth of a mixed pixel is the marker's if it fills at least half.
struct Scene {
  Camera camera = hololens2_ahat();
  Vector3 centre_m{0.05, -0.03, 0.4};
  double radius_m = 0.006;
  MarkerShape shape = MarkerShape::sphere;
  double brightness = 20000;
  double noise_m = 0;

  // Range along a unit ray to the marker; 0 if the ray misses it.
  [[nodiscard]] double range_along(const Vector3& ray) const {
    const double along = ray.dot(centre_m);
    if (shape == MarkerShape::disc) {
      const Vector3 normal = centre_m.normalized();
      const double range = centre_m.norm() / ray.dot(normal);
      return (range * ray - centre_m).norm() < radius_m ? range : 0;
    }
    const double inside = along * along - centre_m.squaredNorm() + radius_m * radius_m;
    return inside > 0 ? along - std::sqrt(inside) : 0;
  }

  [[nodiscard]] FrameBuffer render() const {
    FrameBuffer out;
    out.width = camera.model.width;
    out.height = camera.model.height;
    const auto pixels = static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
    out.reflectivity_16.assign(pixels, 200);
    out.depth.assign(pixels, raw(k_wall_m, Vector3::UnitZ()));
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    const Vector2 middle = project(camera.model, centre_m).value;
    for (int y = std::max(0, static_cast<int>(middle.y()) - 24);
         y < std::min(512.0, middle.y() + 24); ++y) {
      for (int x = std::max(0, static_cast<int>(middle.x()) - 24);
           x < std::min(512.0, middle.x() + 24); ++x) {
        double sum = 0;
        int hits = 0;
        for (int i = 0; i < 16; ++i) {
          const Vector2 part{x + (i % 4 + 0.5) / 4, y + (i / 4 + 0.5) / 4};
          const double range = range_along(unproject(camera.model, part).value);
          sum += range;
          hits += range > 0;
        }
        if (hits == 0) continue;
        const std::size_t at = static_cast<std::size_t>(y * out.width + x);
        out.reflectivity_16[at] =
            static_cast<std::uint16_t>(std::min(200 + brightness * hits / 16, 65535.0));
        const Vector3 ray = unproject(camera.model, {x + 0.5, y + 0.5}).value;
        if (hits >= 8) out.depth[at] = raw(sum / hits + noise_m * normal(random), ray);
      }
    }
    return out;
  }

  [[nodiscard]] std::uint16_t raw(double range, const Vector3& ray) const {
    if (camera.depth.wrap_range_m > 0) range = std::fmod(range, camera.depth.wrap_range_m);
    if (camera.depth.kind == DepthKind::z) range *= ray.z();
    return static_cast<std::uint16_t>(std::lround(range / camera.depth.unit_m));
  }

  [[nodiscard]] double nearest_surface_m() const {
    return centre_m.norm() - (shape == MarkerShape::sphere ? radius_m : 0);
  }
};

Blobs blobs_of(const Scene& scene, const Frame& frame) {
  auto runs = std::make_unique<Runs>();
  auto scratch = std::make_unique<BlobScratch>();
  auto blobs = std::make_unique<Blobs>();
  threshold_runs(frame, whole_frame(frame), scene.camera.threshold, {}, *runs);
  const Runs* bands[] = {runs.get()};
  find_blobs(frame, bands, {2, 4000, scene.camera.threshold, scene.camera.depth.saturated_from}, {},
             *scratch, *blobs);
  return *blobs;
}

// Back-projects the frame's single blob.
Marker marker_of(const Scene& scene, const FrameBuffer& buffer, const NominalMarker& nominal = {}) {
  const Frame frame = buffer.view({}, {}, 0);
  const Blobs blobs = blobs_of(scene, frame);
  EXPECT_EQ(blobs.count, 1);
  Marker marker;
  EXPECT_TRUE(measure_marker(frame, blobs.items[0], 7, scene.camera.model,
                             sphere_offset(scene.camera.model), scene.camera.depth, nominal,
                             marker));
  EXPECT_EQ(marker.blob, 7);
  return marker;
}

TEST(BackProject, FindsASpheresFrontPoint) {
  for (const double z : {0.25, 0.4, 0.6, 0.85}) {
    for (const double side : {0.0, 0.2, 0.5}) {
      Scene scene;
      scene.centre_m = Vector3{side * z, -0.1 * z, z} / std::hypot(1, side);
      const Marker marker = marker_of(scene, scene.render());
      EXPECT_EQ(marker.flags, 0);
      EXPECT_NEAR(marker.surface_range_m, scene.nearest_surface_m(), 0.0005) << z << " " << side;
      const Vector3 centre = marker.ray * (marker.surface_range_m + scene.radius_m);
      EXPECT_LT((centre - scene.centre_m).norm(), 0.001) << z << " " << side;
    }
  }
}

void remove_depth(const Scene& scene, FrameBuffer& buffer, double within_px, bool saturate);

// Near, 40 degrees off the axis of a pinhole: the image centroid is 0.14 px too far from the axis.
TEST(BackProject, MovesASpheresCentroidToWhereItsCentreProjects) {
  Scene scene;
  scene.camera.model.lens = Lens::pinhole;
  scene.camera.depth.wrap_range_m = 0;
  scene.centre_m = Vector3(0.8, 0.2, 1).normalized() * 0.3;
  const FrameBuffer buffer = scene.render();
  const Vector2 centre = project(scene.camera.model, scene.centre_m).value;
  const Blobs blobs = blobs_of(scene, buffer.view({}, {}, 0));
  EXPECT_GT((blobs.items[0].centroid_px - centre).norm(), 0.1);
  const Marker marker = marker_of(scene, buffer);
  EXPECT_LT((marker.centroid_px - centre).norm(), 0.05);
  EXPECT_LT((marker.ray - unproject(scene.camera.model, marker.centroid_px).value).norm(), 1e-6);
  EXPECT_NEAR(marker.ray.norm(), 1, 1e-15);
  // The centroid of a disc is not moved.
  EXPECT_EQ(marker_of(scene, buffer, {0.006, MarkerShape::disc}).centroid_px,
            blobs.items[0].centroid_px);
}

// At the corrected centroid of a sphere as at the unchanged one of a disc.
TEST(BackProject, SaysHowTheRayTurnsWithThePixel) {
  Scene scene;
  scene.camera.model.lens = Lens::pinhole;
  scene.camera.depth.wrap_range_m = 0;
  scene.centre_m = Vector3(0.8, 0.2, 1).normalized() * 0.3;
  const FrameBuffer buffer = scene.render();
  for (const MarkerShape shape : {MarkerShape::sphere, MarkerShape::disc}) {
    const Marker marker = marker_of(scene, buffer, {0.006, shape});
    const Vector3* const along[] = {&marker.along_x, &marker.along_y};
    for (int axis = 0; axis < 2; ++axis) {
      const Vector2 beside = marker.centroid_px + 0.2 * Vector2::Unit(axis);
      const Vector3 turned = unproject(scene.camera.model, beside).value;
      EXPECT_NEAR(marker.ray.dot(*along[axis]), 0, 1e-15);
      EXPECT_LT((turned - marker.ray - 0.2 * *along[axis]).norm(), 0.005 * along[axis]->norm());
    }
  }
}

TEST(BackProject, StatesHowFarItsRangesMeanMayBeOff) {
  for (const double noise_m : {0.002, 0.008}) {
    double squares = 0, variances = 0;
    for (int i = 0; i < 60; ++i) {
      Scene scene;
      scene.noise_m = noise_m;
      scene.centre_m = {0.05 + 0.0013 * i, -0.03 + 0.0007 * i, 0.4};
      const Marker marker = marker_of(scene, scene.render());
      squares += std::pow(marker.surface_range_m - scene.nearest_surface_m(), 2);
      variances += std::pow(marker.range_sigma_m, 2);
      EXPECT_GT(marker.sigma_px[0], 0);
      EXPECT_LT(marker.sigma_px[0], 0.05);
    }
    EXPECT_NEAR(std::sqrt(squares / variances), 1, 0.35) << noise_m;
  }
}

TEST(BackProject, TakesOffADeclaredBias) {
  Scene scene;
  const FrameBuffer buffer = scene.render();
  const double plain = marker_of(scene, buffer).surface_range_m;
  scene.camera.depth.bias = {0.004, 0, 0, 0.1, 1};
  EXPECT_NEAR(marker_of(scene, buffer).surface_range_m, plain - 0.004, 1e-12);
}

TEST(BackProject, StatesAWiderSigmaForTheRing) {
  Scene scene;
  scene.centre_m = {0.05, -0.03, 0.3};
  FrameBuffer buffer = scene.render();
  const float inner = marker_of(scene, buffer).range_sigma_m;
  remove_depth(scene, buffer, 3.6, false);
  const float ring = marker_of(scene, buffer).range_sigma_m;
  EXPECT_GT(ring, 0.001F);
  EXPECT_GT(ring, 1.2F * inner);
}

TEST(BackProject, SaysThatABlobIsLargerThanOneMarker) {
  const Scene scene;
  const FrameBuffer buffer = scene.render();
  const Marker one = marker_of(scene, buffer), many = marker_of(scene, buffer, {0.003});
  EXPECT_EQ(one.flags & k_marker_not_isolated, 0);
  EXPECT_NE(many.flags & k_marker_not_isolated, 0);
  EXPECT_GT(many.sigma_px[0], one.sigma_px[0] + 1);
}

TEST(BackProject, FindsADiscsMiddle) {
  Scene scene;
  scene.shape = MarkerShape::disc;
  const Marker marker = marker_of(scene, scene.render(), {0.006, MarkerShape::disc});
  EXPECT_NEAR(marker.surface_range_m, scene.nearest_surface_m(), 0.0005);
  EXPECT_LT((marker.ray * marker.surface_range_m - scene.centre_m).norm(), 0.0005);
}

TEST(BackProject, TurnsZDepthIntoRadialDepth) {
  Scene scene;
  scene.centre_m = {0.25, 0.1, 0.4};
  scene.camera.depth.kind = DepthKind::z;
  scene.camera.depth.wrap_range_m = 0;
  EXPECT_NEAR(marker_of(scene, scene.render()).surface_range_m, scene.nearest_surface_m(), 0.0007);
}

TEST(BackProject, AveragesTheNoiseOfItsPixels) {
  Scene scene;
  scene.noise_m = 0.005;
  scene.centre_m = {0.05, -0.03, 0.3};
  EXPECT_NEAR(marker_of(scene, scene.render()).surface_range_m, scene.nearest_surface_m(), 0.003);
}

// Invalidates the depth of pixels within this distance of the marker's centre.
void remove_depth(const Scene& scene, FrameBuffer& buffer, double within_px, bool saturate) {
  const Vector2 middle = project(scene.camera.model, scene.centre_m).value;
  for (int y = 0; y < buffer.height; ++y) {
    for (int x = 0; x < buffer.width; ++x) {
      if ((Vector2{x + 0.5, y + 0.5} - middle).norm() > within_px) continue;
      const auto at = static_cast<std::size_t>(y * buffer.width + x);
      if (saturate) {
        buffer.reflectivity_16[at] = 0xFFFF;
        buffer.depth[at] = 123;
      } else {
        buffer.depth[at] = 0;
      }
    }
  }
}

TEST(BackProject, TakesTheRingWhereTheCentreHasNoDepth) {
  for (const bool saturate : {false, true}) {
    Scene scene;
    scene.centre_m = {0.05, -0.03, 0.3};  // radius 5 px
    FrameBuffer buffer = scene.render();
    remove_depth(scene, buffer, 3.6, saturate);
    const Marker marker = marker_of(scene, buffer);
    EXPECT_EQ(marker.flags & k_marker_annulus_depth, k_marker_annulus_depth);
    EXPECT_EQ((marker.flags & k_marker_saturated) != 0, saturate);
    EXPECT_NEAR(marker.surface_range_m, scene.nearest_surface_m(), 0.001);
  }
}

TEST(BackProject, SaysSoWhereThereIsNoDepthAtAll) {
  Scene scene;
  FrameBuffer buffer = scene.render();
  remove_depth(scene, buffer, 9, false);
  const Marker without_depth = marker_of(scene, buffer);
  EXPECT_EQ(without_depth.flags, k_marker_no_depth);
  EXPECT_EQ(without_depth.surface_range_m, 0);
  for (auto& value : buffer.depth) value = 4090;  // invalid from this value on
  EXPECT_EQ(marker_of(scene, buffer).flags, k_marker_no_depth);
  buffer.depth.clear();
  EXPECT_EQ(marker_of(scene, buffer).flags, k_marker_no_depth);
}

TEST(BackProject, IsNotPulledByMixedPixels) {
  Scene scene;
  scene.centre_m = {0.05, -0.03, 0.35};
  FrameBuffer buffer = scene.render();
  const Vector2 middle = project(scene.camera.model, scene.centre_m).value;
  const int x = static_cast<int>(middle.x()), y = static_cast<int>(middle.y());
  buffer.depth[static_cast<std::size_t>(y * 512 + x)] = 700;
  buffer.depth[static_cast<std::size_t>((y + 1) * 512 + x)] = 650;
  EXPECT_NEAR(marker_of(scene, buffer).surface_range_m, scene.nearest_surface_m(), 0.0007);
}

TEST(BackProject, FindsAndFlagsAWrappedRange) {
  for (const double z : {1.1, 1.25, 1.4}) {
    Scene scene;
    scene.centre_m = {0.1, 0.05, z};
    const Marker marker = marker_of(scene, scene.render());
    EXPECT_EQ(marker.flags, k_marker_wrapped) << z;
    EXPECT_NEAR(marker.surface_range_m, scene.nearest_surface_m(), 0.0015) << z;
  }
  for (const double z : {0.15, 0.5, 0.9, 1.0}) {
    Scene scene;
    scene.centre_m = {0.02, 0.01, z};
    EXPECT_EQ(marker_of(scene, scene.render()).flags, 0) << z;
  }
}

// The area of a blob cut by the border indicates neither a wrapped range nor a second marker.
TEST(BackProject, ConcludesNothingFromTheAreaOfABlobThatTheBorderCuts) {
  const auto cut_marker_of = [](const Scene& scene, const NominalMarker& nominal) {
    const FrameBuffer buffer = scene.render();
    const Frame frame = buffer.view({}, {}, 0);
    Blob blob = blobs_of(scene, frame).items[0];
    blob.flags |= k_blob_touches_edge;
    Marker marker;
    EXPECT_TRUE(measure_marker(frame, blob, 0, scene.camera.model, {}, scene.camera.depth, nominal,
                               marker));
    return marker;
  };
  Scene far;
  far.centre_m = {0.1, 0.05, 1.25};
  const Marker wrapped = cut_marker_of(far, {});
  EXPECT_EQ(wrapped.flags, k_marker_touches_edge);
  EXPECT_LT(wrapped.surface_range_m, 0.25);
  const Marker large = cut_marker_of(Scene{}, {0.003});
  EXPECT_EQ(large.flags, k_marker_touches_edge);
  EXPECT_LT(large.sigma_px[0], 1.0F);
}

TEST(BackProject, DoesNotSearchAWrapWithoutANominalRadius) {
  Scene scene;
  scene.centre_m = {0.1, 0.05, 1.25};
  const Marker marker = marker_of(scene, scene.render(), {0, MarkerShape::sphere});
  EXPECT_EQ(marker.flags, 0);
  EXPECT_LT(marker.surface_range_m, 0.25);
}

TEST(BackProject, ExpectsTheAreaThatASphereCovers) {
  for (const double side : {0.0, 0.3, 0.7}) {
    Scene scene;
    scene.centre_m = {side * 0.25, 0.02, 0.25};
    scene.camera.threshold = 10200;  // half the brightness: the edge itself
    const Marker marker = marker_of(scene, scene.render());
    const double expected = expected_area_px(scene.camera.model, marker.centroid_px, scene.radius_m,
                                             scene.centre_m.norm());
    EXPECT_NEAR(marker.area_px / expected, 1, 0.06) << side;
  }
  const CameraModel camera = hololens2_ahat().model;
  EXPECT_EQ(expected_area_px(camera, {1, 1}, 0.006, 0.5), 0);
  EXPECT_EQ(expected_area_px(camera, {256, 256}, 0.006, 0), 0);
}

TEST(BackProject, RefusesABlobOutsideTheLens) {
  const Scene scene;
  const FrameBuffer buffer = scene.render();
  Blob blob;
  blob.centroid_px = {2, 2};
  blob.area_px = 30;
  Marker marker;
  EXPECT_FALSE(measure_marker(buffer.view({}, {}, 0), blob, 0, scene.camera.model, {},
                              scene.camera.depth, {}, marker));
}

// Worst input: the largest blob, at a corner, without depth at its centre.
TEST(BackProject, BoundsItsWorkOnAHugeBlob) {
  Scene scene;
  scene.camera.model.lens = Lens::pinhole;
  FrameBuffer buffer = scene.render();
  buffer.depth.assign(buffer.depth.size(), 500);
  buffer.reflectivity_16.assign(buffer.reflectivity_16.size(), 0xFFFF);
  Blob blob;
  blob.centroid_px = {0.5, 511.5};
  blob.area_px = 512 * 512;
  blob.x1 = blob.y1 = 512;
  blob.peak = 0xFFFF;
  blob.flags = k_blob_touches_edge | k_blob_saturated;
  Marker marker;
  EXPECT_TRUE(measure_marker(buffer.view({}, {}, 0), blob, 0, scene.camera.model, {},
                             scene.camera.depth, {}, marker));
  EXPECT_EQ(marker.flags, k_marker_no_depth | k_marker_saturated | k_marker_touches_edge);
  for (auto& value : buffer.reflectivity_16) value = 30000;
  EXPECT_TRUE(measure_marker(buffer.view({}, {}, 0), blob, 0, scene.camera.model, {},
                             scene.camera.depth, {}, marker));
  EXPECT_GT(marker.surface_range_m, 0.49);
}

}  // namespace
}  // namespace glint
