#include "platform/runtime/session/calibration_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "platform/cells/tool_file.hpp"
#include "platform/runtime/session/pipeline.hpp"
#include "platform/sim/hand_motion.hpp"
#include "platform/sim/simulator.hpp"
#include "platform/sinks/dds/diagnostics.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"
#include "tests/unit/platform/sinks/dds/diagnostic_entry.hpp"

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
    if (!finding.exceeds_stated) continue;
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
    // The scale error within its stated limits explains the rest.
    EXPECT_NEAR(found->estimate, offset_m, 0.008);
    EXPECT_LT(std::abs(found->estimate - offset_m), 3 * found->sigma);
    EXPECT_GT(found->size_in_stated_sigmas, 2.5);
  }
}

TEST(CalibrationWatch, NamesNothingOfADeviceAsStated) {
  const std::vector<CalibrationFinding> findings = findings_of({});
  EXPECT_EQ(findings.size(), 5u);
  EXPECT_EQ(named(findings), nullptr);
}

Cell cell_with_reference_body(double seconds) {
  Cell cell = short_cell(seconds, "outputs");
  cell.reference = cell.tools.count;
  cell.tools.items[static_cast<std::size_t>(cell.tools.count++)] = reference_body();
  return cell;
}

// A reference body on the table; the head sways and rotates.
sim::Scenario rotating_head_scenario(const Cell& cell) {
  sim::Scenario scenario = scenario_of(cell);
  sim::HeadSettings head;
  head.target_m = Vector3(0.44, 0, -0.2);
  head.sway_rms_m = 0.1;
  head.gaze_rms_rad = 0.25;
  scenario.head = sim::head_motion(head, 4);
  scenario.device.exists = true;
  return scenario;
}

std::vector<CalibrationFinding> findings_beside_a_body(double latency_s, double drift) {
  const TemporaryFolder folder;
  const Cell cell = cell_with_reference_body(k_seconds);
  sim::Scenario scenario = rotating_head_scenario(cell);
  scenario.localisation.latency_s = latency_s;
  sim::LocalisationSettings& own = scenario.localisation;
  for (double* part : {&own.rest_position_m, &own.rest_angle_rad, &own.position_per_speed_s,
                       &own.position_per_angular_speed_m, &own.angle_per_speed_s_m,
                       &own.angle_per_angular_speed_s})
    *part *= drift;
  return short_run(cell, scenario, folder.path()).calibration;
}

TEST(CalibrationWatch, NamesTheTimeOfTheHeadPosesByABodyAtRest) {
  const std::vector<CalibrationFinding> findings = findings_beside_a_body(0.025, 0.5);
  const CalibrationFinding* const found = named(findings);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->source, ErrorSource::time_offset);
  EXPECT_NEAR(found->estimate, -0.025, 0.01) << "the poses are late";
  EXPECT_NE(text_of(*found).find("use one clock for the stamps of head poses and frames"),
            std::string::npos);
}

TEST(CalibrationWatch, NamesTheHeadsetsDriftByABodyAtRest) {
  const std::vector<CalibrationFinding> findings = findings_beside_a_body(0, 4);
  const CalibrationFinding* const found = named(findings);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->source, ErrorSource::head_drift);
  EXPECT_GT(found->estimate, 2);
  EXPECT_LT(found->estimate, 5);
}

// 4 s, then time stamps one hour earlier for 6 s: neither part alone has enough observations.
TEST(CalibrationWatch, SeesTheBodyAfterTheStampsRestart) {
  const Cell cell = cell_with_reference_body(10);
  const sim::Simulator simulator(rotating_head_scenario(cell));
  const auto tracker = std::make_unique<Tracker>();
  configure(cell, *tracker);
  tracker->latest<ToolSet>().set(cell.tools, 1, 0);
  CalibrationMonitor watch(cell);
  sim::SimFrame frame;
  for (int i = 0; i < simulator.frame_count(); ++i) {
    simulator.render(i, frame);
    const Duration earlier =
        frame.mid_exposure < Time{} + milliseconds(4000) ? Duration{} : milliseconds(-3'600'000);
    frame.mid_exposure = frame.head.time = frame.mid_exposure + earlier;
    frame.arrival = frame.arrival + earlier;
    tracker->input<Frame>() = frame.view();
    tracker->input<HeadPose>() = frame.head;
    tracker->activate();
    watch.add_frame(*tracker);
  }
  EXPECT_EQ(tracker->output<Estimates>().verdict.resynchronisations, 1u);
  const std::vector<CalibrationFinding> findings = watch.findings();
  EXPECT_TRUE(std::any_of(findings.begin(), findings.end(), [](const CalibrationFinding& one) {
    return one.source == ErrorSource::time_offset;
  }));
}

TEST(CalibrationWatch, NamesNothingByABodyAtRestBeforeADeviceAsStated) {
  const std::vector<CalibrationFinding> findings = findings_beside_a_body(0.003, 1);
  EXPECT_EQ(named(findings), nullptr);
  EXPECT_EQ(std::count_if(findings.begin(), findings.end(),
                          [](const CalibrationFinding& one) {
                            return one.source == ErrorSource::time_offset ||
                                   one.source == ErrorSource::head_drift;
                          }),
            2);
}

TEST(CalibrationWatch, IsAWarningOfDiagnostics) {
  CalibrationFinding finding;
  finding.source = ErrorSource::range_offset;
  finding.estimate = 0.024;
  finding.sigma = 0.0011;
  finding.size_in_stated_sigmas = 4;
  CalibrationFindingsStore notes;
  const auto entry = [&] {
    Diagnostics text;
    text.add_calibration(notes.all());
    return entry_of(text.message(Time{}), "glint: calibration");
  };
  EXPECT_EQ(entry().message, "too few data");
  notes.set({finding});
  EXPECT_EQ(entry().level, 0);
  EXPECT_EQ(entry().message, "as stated");
  finding.exceeds_stated = true;
  notes.set({finding});
  EXPECT_EQ(entry().level, 1);
  EXPECT_EQ(
      entry().message,
      "range offset 24.00 mm (sigma 1.10), 4.0 times the stated sigma; glint calibrate depth");
  EXPECT_EQ(entry().values.size(), 1u) << "the newest ones alone";
  EXPECT_EQ(entry().values.count("range offset"), 1u);
  finding.tool = "pen";
  finding.source = ErrorSource::range;
  finding.range_m = 0.48;
  notes.set({finding});
  EXPECT_EQ(
      entry().message,
      "pen: range offset or scale 24.00 mm at 480 mm (sigma 1.10), 4.0 times the stated sigma; "
      "glint calibrate depth");
}

}  // namespace
}  // namespace glint::calibration_watch_test
