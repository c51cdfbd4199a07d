#include "platform/session/calibration_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "platform/dds/diagnostics.hpp"
#include "tests/unit/platform/dds/diagnostic_entry.hpp"
#include "tests/unit/platform/session/short_run.hpp"

namespace glint::calibration_watch_test {
namespace {

constexpr double k_seconds = 15;

std::vector<CalibrationFinding> findings_of(const sim::DeviceErrors& device) {
  const TemporaryFolder folder;
  const Cell cell = short_cell(k_seconds, "outputs");
  sim::Scenario scenario = scenario_of(cell);
  scenario.device = device;
  scenario.device.exists = true;
  return short_run(cell, scenario, folder.path()).calibration;
}

const CalibrationFinding* named(const std::vector<CalibrationFinding>& findings) {
  const CalibrationFinding* found = nullptr;
  for (const CalibrationFinding& finding : findings) {
    if (!finding.named) continue;
    EXPECT_EQ(found, nullptr) << name_of(finding.source);
    found = &finding;
  }
  return found;
}

TEST(CalibrationWatch, NamesARangeOffset) {
  for (const double offset_m : {0.024, -0.024}) {
    const std::vector<CalibrationFinding> findings = findings_of({.range_offset_m = offset_m});
    const CalibrationFinding* const found = named(findings);
    ASSERT_NE(found, nullptr);
    EXPECT_TRUE(found->source == ErrorSource::range || found->source == ErrorSource::range_offset);
    EXPECT_NEAR(found->estimate, offset_m, 0.006);
    EXPECT_LT(std::abs(found->estimate - offset_m), 3 * found->sigma);
    EXPECT_GT(found->stated_sigmas, 2.5);
  }
}

TEST(CalibrationWatch, NamesNothingOfADeviceAsStated) {
  const std::vector<CalibrationFinding> findings = findings_of({});
  EXPECT_EQ(findings.size(), 5u);
  EXPECT_EQ(named(findings), nullptr);
}

TEST(CalibrationWatch, IsAWarningOfDiagnostics) {
  CalibrationFinding finding;
  finding.source = ErrorSource::range_offset;
  finding.estimate = 0.024;
  finding.sigma = 0.0011;
  finding.stated_sigmas = 4;
  CalibrationNotes notes;
  const auto entry = [&] {
    Diagnostics text;
    text.add_calibration(notes.all());
    return entry_of(text.message(Time{}), "glint: calibration");
  };
  EXPECT_EQ(entry().message, "too little seen");
  notes.set({finding});
  EXPECT_EQ(entry().level, 0);
  EXPECT_EQ(entry().message, "as stated");
  finding.named = true;
  notes.set({finding});
  EXPECT_EQ(entry().level, 1);
  EXPECT_EQ(entry().message,
            "range offset 24.00 mm (sigma 1.10), 4.0 times what is stated; glint calibrate depth");
  EXPECT_EQ(entry().values.size(), 1u) << "the newest ones alone";
  EXPECT_EQ(entry().values.count("range offset"), 1u);
  finding.tool = "pen";
  finding.source = ErrorSource::range;
  finding.range_m = 0.48;
  notes.set({finding});
  EXPECT_EQ(entry().message,
            "pen: range offset or scale 24.00 mm at 480 mm (sigma 1.10), 4.0 times what is stated; "
            "glint calibrate depth");
}

}  // namespace
}  // namespace glint::calibration_watch_test
