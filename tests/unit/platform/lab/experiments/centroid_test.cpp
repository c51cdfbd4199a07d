#include <gtest/gtest.h>

#include "platform/lab/experiments/centroid_cases.hpp"
#include "platform/lab/experiments/centroid_experiment.hpp"
#include "platform/lab/experiments/centroid_methods.hpp"

namespace glint {
namespace {

TEST(CentroidExperiment, HoldsItsBarsInAQuickRun) {
  CaseOptions options;
  options.quick = true;
  options.out = ::testing::TempDir();
  const CaseList list = run_centroid_experiment(options);
  EXPECT_EQ(missed_bars(list), 0) << case_table(list);
  EXPECT_EQ(list.plots.size(), 5U);
}

// The test must be able to fail: a covariance for a tenth of the noise is too small.
TEST(CentroidExperiment, WouldSeeASigmaThatIsTooSmall) {
  CentroidCase weak = sized_cases().back();
  weak.stated.read_counts /= 10;
  SphereImages pictures(weak.setting, 3);
  CentroidMethods methods(pictures.camera(), weak.stated, {weak.setting.radius_m});
  FrameBuffer buffer;
  double squares = 0, variances = 0;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Vector2 truth = pictures.render(i, buffer).centre_px;
    const auto located = methods.locate(buffer.view({}, {}, 0), truth);
    ASSERT_TRUE(located);
    squares += (located->blob.centroid_px - truth).squaredNorm();
    variances += double{located->blob.variance_px2[0]} + double{located->blob.variance_px2[1]};
  }
  EXPECT_GT(squares, 1.4 * 1.4 * variances);
}

// Image i does not depend on the images rendered before it.
TEST(SpherePictures, DependOnTheirNumberAlone) {
  const CentroidCase one = sized_cases().front();
  SphereImages forward(one.setting, 5), back(one.setting, 5);
  FrameBuffer a, b;
  (void)forward.render(0, a);
  (void)forward.render(1, a);
  (void)back.render(1, b);
  EXPECT_EQ(a.reflectivity_16, b.reflectivity_16);
  EXPECT_EQ(a.depth, b.depth);
}

}  // namespace
}  // namespace glint
