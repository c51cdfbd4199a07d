#include "platform/tools/verify/verification.hpp"

#include <gtest/gtest.h>

#include "tests/unit/platform/tools/calibrate/expect_message.hpp"
#include "tests/unit/platform/tools/verify/made_touches.hpp"

namespace glint::verification_test {
namespace {

using test::SyntheticTouches;

Verification verified(const SyntheticTouches& made) {
  return verify_touches(test::series_of(made), {test::k_made_distance_m, 0.0001});
}

std::vector<ErrorSource> named_of(const Verification& found) {
  std::vector<ErrorSource> named;
  for (const CalibrationFinding& one : found.calibration)
    if (one.exceeds_stated) named.push_back(one.source);
  return named;
}

TEST(Verification, AgreesWithErrorsAsStated) {
  const Verification found = verified({.errors = {1, -1, 0.5}});
  EXPECT_TRUE(found.agrees);
  EXPECT_EQ(found.first_touches, 10);
  EXPECT_EQ(found.second_touches, 5);
  EXPECT_EQ(found.other_holds, 0);
  EXPECT_LT(found.repeatability.measured_m, found.repeatability.stated_m);
  EXPECT_NEAR(found.distance_m, test::k_made_distance_m, 0.001);
  // Five tests: repeatability, scale, rest, range, principal point.
  EXPECT_NEAR(found.level, 0.05 / 5, 1e-12);
}

TEST(Verification, NamesTheCalibrationErrorOfFourSigma) {
  const Verification range = verified({.errors = {4, 0, 0}});
  EXPECT_FALSE(range.agrees);
  EXPECT_EQ(named_of(range), std::vector<ErrorSource>{ErrorSource::range});
  EXPECT_NEAR(range.calibration[0].estimate, 4 * CameraUncertainty{}.range_offset_m, 0.002);
  const Verification lens = verified({.errors = {0, -4, 0}});
  EXPECT_FALSE(lens.agrees);
  EXPECT_EQ(named_of(lens), std::vector<ErrorSource>{ErrorSource::principal_point});
}

// The touches are 4 mm off the point in alternating directions; no stated error explains that.
TEST(Verification, RefusesTouchesThatDoNotRepeat) {
  const Verification found = verified({.drift = [](int touch, double) {
    return touch < 0 ? Vector3::Zero() : Vector3(0.004 * (touch % 2 == 0 ? 1 : -1), 0, 0);
  }});
  EXPECT_FALSE(found.repeatability.agrees);
  EXPECT_TRUE(found.rest.agrees);
  EXPECT_FALSE(found.agrees);
}

TEST(Verification, RefusesAnotherDistance) {
  EXPECT_TRUE(verified({.distance_m = test::k_made_distance_m + 0.0002}).scale.agrees);
  const Verification found = verified({.distance_m = test::k_made_distance_m + 0.006});
  EXPECT_NEAR(found.scale.measured_m, 0.006, 0.001);
  EXPECT_FALSE(found.scale.agrees);
  EXPECT_FALSE(found.agrees);
}

TEST(Verification, RefusesARestThatWanders) {
  const Verification found = verified({.drift = [](int touch, double seconds) {
    return touch < 0 ? Vector3(0.004 * std::sin(3 * seconds), 0, 0) : Vector3::Zero();
  }});
  EXPECT_TRUE(found.repeatability.agrees);
  EXPECT_FALSE(found.rest.agrees);
  EXPECT_FALSE(found.agrees);
}

TEST(Verification, NamesWhatTheRecordingLacks) {
  const auto expect_missing = [](const SyntheticTouches& made,
                                 std::initializer_list<const char*> words) {
    test::expect_input_error([&] { (void)verified(made); }, words);
  };
  expect_missing({.touches = 12}, {"made: 8 touches of one point; expected at least 10"});
  expect_missing({.distance_m = 0.4}, {"no touch of a second point"});
  expect_missing({.lean_rad = 0.02}, {"the touches are too similar", "lean the tool"});
  expect_missing({.rest_s = 9}, {"the tool rests for", "expected 20 s"});
}

// If an error makes the tracker lose the tool, the residuals of its fits identify the error.
TEST(Verification, TakesFitsAloneWhereTouchesLack) {
  TipSeries series = test::series_of({.touches = 3});
  series.residuals.fits = 30;
  series.residuals.information(0, 0) = 20;
  series.residuals.information_vector(0) = 4 * 20;
  const Verification found = verify_touches(series, {test::k_made_distance_m, 0.0001});
  EXPECT_FALSE(found.agrees);
  EXPECT_EQ(named_of(found), std::vector<ErrorSource>{ErrorSource::range});
  EXPECT_NE(found.missing.find("2 touches"), std::string::npos);
}

TEST(Verification, ListsWhatItDoesNotShow) {
  const std::vector<std::string> lines = not_covered(verified({}));
  const auto has = [&](const char* words) {
    return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
      return line.find(words) != std::string::npos;
    });
  };
  EXPECT_TRUE(has("common to all touches"));
  EXPECT_TRUE(has("a scale error below 0."));
  EXPECT_TRUE(has("focal length"));
  EXPECT_FALSE(has("principal point"));
}

}  // namespace
}  // namespace glint::verification_test
