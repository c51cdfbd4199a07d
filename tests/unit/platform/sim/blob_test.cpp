// Simulated marker blobs: centroid and range.
#include <gtest/gtest.h>

#include <cmath>

#include "platform/sim/scene.hpp"
#include "small_scene.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint::sim {
namespace {

// Centre of a sphere's elliptic silhouette, from its two rims along the line from the principal
// point: f tan(theta +- a), sin a = r / range.
Vector2 silhouette_centre(const Scenario& scenario, const Vector3& place, double radius) {
  const double range = place.norm(), f = scenario.camera.model.fx;
  const double tilt = std::atan2(std::hypot(place.x(), place.y()), place.z());
  const double half = std::asin(radius / range);
  const double along = 0.5 * f * (std::tan(tilt + half) + std::tan(tilt - half));
  const Vector2 side(place.x(), place.y());
  const Vector2 direction = side.norm() > 1e-12 ? Vector2(side.normalized()) : Vector2(0, 0);
  return Vector2(scenario.camera.model.cx, scenario.camera.model.cy) + along * direction;
}

TEST(Blob, HasItsCentroidWhereTheSilhouetteIs) {
  SimFrame frame;
  double squares = 0;
  int n = 0;
  for (int step = 0; step < 12; ++step) {
    const Scenario scenario =
        dark_scene({0.003 + 0.00031 * step, -0.002 + 0.00017 * step, 0.45 + 0.01 * step});
    Simulator(scenario).render(0, frame);
    for (int i = 0; i < 5; ++i) {
      const Vector3 place = scenario.tools[0].motion->pose(Time{}) *
                            scenario.tools[0].tool.markers_m[static_cast<std::size_t>(i)];
      const Vector2 expected = silhouette_centre(scenario, place, 0.0055);
      const Vector2 miss = measure(frame, projected(scenario, i)).centroid - expected;
      EXPECT_LT(miss.norm(), 0.02) << step << " " << i;
      squares += miss.squaredNorm();
      n += 2;
    }
  }
  EXPECT_LT(std::sqrt(squares / n), 0.006);
}

TEST(Blob, OfADiscHasItsCentroidThere) {
  const Scenario scenario = dark_scene({0.003, -0.002, 0.5}, MarkerShape::disc);
  SimFrame frame;
  Simulator(scenario).render(0, frame);
  for (int i = 0; i < 5; ++i) {
    const Measured measured = measure(frame, projected(scenario, i));
    EXPECT_LT((measured.centroid - projected(scenario, i)).norm(), 0.02);
    const Vector3 place = scenario.tools[0].motion->pose(Time{}) *
                          scenario.tools[0].tool.markers_m[static_cast<std::size_t>(i)];
    EXPECT_NEAR(measured.range_m, place.norm(), 0.0006);
  }
}

TEST(Blob, CoversTheAreaOfItsSphere) {
  const Scenario scenario = dark_scene();
  SimFrame frame;
  Simulator(scenario).render(0, frame);
  double covered = 0;
  const double full_signal = 8000 * 0.25;  // full signal: counts times range squared
  for (int y = 70; y < 90; ++y) {
    for (int x = 70; x < 95; ++x) covered += frame.view().reflectivity_16.row(y)[x];
  }
  const double radius_px = 253 * 0.0055 / 0.5;
  const double area = covered / (full_signal / (0.4945 * 0.4945));
  EXPECT_NEAR(area, 3.14159265 * radius_px * radius_px, 0.35);
}

TEST(Blob, HasTheDepthOfItsFrontPoint) {
  const Scenario scenario = dark_scene();
  SimFrame frame;
  Simulator(scenario).render(0, frame);
  for (int i = 0; i < 5; ++i) {
    const Vector3 place = scenario.tools[0].motion->pose(Time{}) *
                          scenario.tools[0].tool.markers_m[static_cast<std::size_t>(i)];
    const double range = measure(frame, projected(scenario, i)).range_m;
    EXPECT_GT(range, place.norm() - 0.0055 - 0.0006);
    EXPECT_LT(range, place.norm() - 0.0055 + 0.0015);  // the sphere curves away beside it
  }
}

TEST(Blob, HasItsDeclaredErrorsAsLongAsItIsAHalfMetreAway) {
  const Scenario clean = dark_scene();
  Scenario noisy = dark_scene();
  noisy.noise = NoiseSettings{};
  noisy.signal.sphere_limb = 0.6;
  noisy.duration = milliseconds(test::repetitions(9000, 1800));
  const Simulator simulator(noisy);
  SimFrame reference, frame;
  Simulator(clean).render(0, reference);
  double pixel2 = 0, range2 = 0, range1 = 0;
  int n = 0;
  for (int k = 0; k < simulator.frame_count(); ++k) {
    simulator.render(k, frame);
    for (int i = 0; i < 5; ++i) {
      const Measured truth = measure(reference, projected(clean, i));
      // Only pixels well above the dark noise contribute to the centroid.
      for (auto& value : frame.pixels.reflectivity_16) {
        if (value < 60) value = 0;
      }
      const Measured measured = measure(frame, projected(clean, i));
      pixel2 += (measured.centroid - truth.centroid).squaredNorm() / 2;
      range1 += measured.range_m - truth.range_m;
      range2 += (measured.range_m - truth.range_m) * (measured.range_m - truth.range_m);
      ++n;
    }
  }
  ASSERT_GT(n, test::repetitions(2000, 400));
  EXPECT_NEAR(std::sqrt(pixel2 / n), 0.1, 0.006);
  EXPECT_NEAR(std::sqrt(range2 / n), 0.0015, 0.0001);
  EXPECT_NEAR(range1 / n, 0, 0.0001);
}

TEST(Blob, RangeErrorGrowsWithTheRange) {
  const auto spread = [](double z) {
    Scenario noisy = dark_scene({0, 0, z});
    noisy.noise.blob_range_sigma_m = 0.0015;
    noisy.duration = milliseconds(30'000);
    Scene scene;
    double squares = 0;
    int n = 0;
    for (std::uint32_t sequence = 0; sequence < 1000; ++sequence) {
      build_scene(noisy, Time{}, sequence, scene);
      for (int i = 0; i < scene.reflectors.count; ++i) {
        squares += scene.reflectors[i].range_error_m * scene.reflectors[i].range_error_m;
        ++n;
      }
    }
    return std::sqrt(squares / n);
  };
  EXPECT_NEAR(spread(0.5), 0.0015, 0.00008);
  EXPECT_NEAR(spread(0.8) / spread(0.5), 1.6, 0.05);
}

// Horizontal variance of the light of the centre marker.
double variance_across(const SimFrame& frame) {
  double sum = 0, first = 0, second = 0;
  for (int y = 70; y < 90; ++y) {
    for (int x = 68; x < 92; ++x) {
      const double signal = frame.view().reflectivity_16.row(y)[x], place = x + 0.5 - 80;
      sum += signal;
      first += signal * place;
      second += signal * place * place;
    }
  }
  return second / sum - (first / sum) * (first / sum);
}

TEST(Blob, SmearsAboutItsPlaceAtMidExposure) {
  class Passing final : public Motion {
   public:
    [[nodiscard]] Pose pose(Time time) const override {
      return {Quaternion::Identity(), Vector3(1.5 * Duration{time.nanoseconds}.seconds(), 0, 0.5)};
    }
  };
  Scenario scenario = dark_scene();
  scenario.tools[0].motion = std::make_shared<Passing>();
  SimFrame moving, still;
  Simulator(scenario).render(0, moving);
  scenario.tools[0].motion = fixed_motion({Quaternion::Identity(), Vector3(0, 0, 0.5)});
  Simulator(scenario).render(0, still);
  for (int i = 0; i < 5; ++i) {
    const Measured a = measure(moving, projected(scenario, i));
    const Measured b = measure(still, projected(scenario, i));
    EXPECT_LT((a.centroid - b.centroid).norm(), 0.02);
  }
  // A uniform motion blur adds its length squared / 12 to the variance. The ray grid makes each
  // variance uncertain by 0.02.
  const double length_px = 253 * 1.5 * 0.002 / 0.5;
  EXPECT_NEAR(variance_across(moving) - variance_across(still), length_px * length_px / 12, 0.04);
}

TEST(Blob, MixesWithTheBackgroundAtItsRim) {
  Scenario scenario = dark_scene({0, 0, 0.5});
  scenario.background.reflectivity.assign(160 * 160, 200.0f);
  scenario.background.range_m.assign(160 * 160, 1.5f);
  SimFrame frame;
  Simulator(scenario).render(0, frame);
  int own = 0, mixed = 0;
  for (int x = 72; x < 88; ++x) {
    const int depth = frame.view().depth.row(80)[x];
    own += depth >= 494 && depth <= 500 ? 1 : 0;
    mixed += depth > 502 && depth < 1498 ? 1 : 0;
  }
  EXPECT_GE(own, 4);
  EXPECT_GE(mixed, 1);
}

}  // namespace
}  // namespace glint::sim
