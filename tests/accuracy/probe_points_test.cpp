// A real hand-held probe of six markers, a nearly symmetric grid, as unlabelled points: it must be
// found in every frame, and at the same place as with the labels of the motion-capture system.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "kernels/pose/rigid_fit.hpp"
#include "platform/sensors/c3d_reader.hpp"
#include "platform/sensors/points_csv.hpp"
#include "platform/session/replay_points.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint {
namespace {

std::string data_folder() {
  const char* folder = std::getenv("GLINT_TEST_DATA");
  return std::string(folder == nullptr ? "" : folder) + "/marker_mocap/";
}

Tool probe_from(const std::string& path) {
  Tool tool;
  std::ifstream in(path);
  std::string line;
  while (std::getline(in, line)) {
    if (line.rfind("Probe", 0) != 0 || line.rfind("ProbeTip", 0) == 0) continue;
    Vector3& marker = tool.markers_m[static_cast<std::size_t>(tool.marker_count++)];
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream row(line);
    std::string name;
    row >> name >> marker.x() >> marker.y() >> marker.z();
  }
  if (prepare_tool(tool) != Reason::none) tool.marker_count = 0;
  return as_points(tool);
}

// The labelled probe markers of a frame, NaN where missing.
std::vector<Vector3> probe_markers(const C3dTrial& trial, std::size_t frame) {
  std::vector<Vector3> markers;
  for (int i = 1; i <= 6; ++i) {
    const int index = trial.index_of("Probe" + std::to_string(i));
    markers.push_back(index < 0 ? Vector3::Constant(NAN)
                                : trial.frames[frame][static_cast<std::size_t>(index)]);
  }
  return markers;
}

RigidFit labelled_fit(const Tool& probe, const std::vector<Vector3>& markers) {
  std::vector<Vector3> model, measured;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    if (!std::isfinite(markers[i].sum())) continue;
    model.push_back(probe.markers_m[i]);
    measured.push_back(markers[i]);
  }
  return fit_rigid(model, measured);
}

// The trial as the file that a user would hand in: rows shuffled within their frame, no labels.
void write_shuffled(const C3dTrial& trial, const std::string& path) {
  test::Random random(1);
  std::ofstream out(path);
  out << "time_s,x_m,y_m,z_m\n";
  out.precision(9);
  for (std::size_t f = 0; f < trial.frames.size(); ++f) {
    std::vector<Vector3> markers = probe_markers(trial, f);
    for (std::size_t k = markers.size(); k > 1; --k) {
      std::swap(markers[k - 1],
                markers[static_cast<std::size_t>(random.below(static_cast<int>(k)))]);
    }
    for (const Vector3& m : markers) {
      if (!std::isfinite(m.sum())) continue;
      out << static_cast<double>(f) / trial.rate_hz << ',' << m.x() << ',' << m.y() << ',' << m.z()
          << '\n';
    }
  }
}

// The probe as a tool file: its tip is its origin.
void write_tool(const Tool& probe, const std::string& path) {
  std::ofstream out(path);
  out.precision(17);
  out << "name = \"probe\"\nradius_mm = 1\ntip_mm = [0, 0, 0]\nmarkers_mm = [";
  for (int i = 0; i < probe.marker_count; ++i) {
    const Vector3 mm = probe.markers_m[static_cast<std::size_t>(i)] * 1e3;
    out << (i == 0 ? "" : ", ") << '[' << mm.x() << ", " << mm.y() << ", " << mm.z() << ']';
  }
  out << "]\n";
}

class ProbePoints : public testing::TestWithParam<const char*> {};

TEST_P(ProbePoints, AreSolvedInEveryFrameWhereTheLabelsPutTheTip) {
  const std::string path = data_folder() + GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path << "; set GLINT_TEST_DATA";
  const Tool probe = probe_from(data_folder() + "ktk_probe_geometry.csv");
  ASSERT_EQ(probe.marker_count, 6);
  const C3dTrial trial = C3dFile(path).read();
  ASSERT_EQ(trial.frames.size(), 140u);
  const std::string csv = testing::TempDir() + "probe_points_" + std::to_string(getpid()) + ".csv";
  write_shuffled(trial, csv);
  const std::string tool = csv + ".toml";
  write_tool(probe, tool);
  const PointsResult result = replay_points(csv, tool);
  std::filesystem::remove(csv);
  std::filesystem::remove(tool);
  ASSERT_EQ(result.frames.size(), trial.frames.size());
  EXPECT_EQ(result.solved, 140);

  double tip_most = 0;
  for (std::size_t f = 0; f < result.frames.size(); ++f) {
    const RigidFit reference = labelled_fit(probe, probe_markers(trial, f));
    ASSERT_EQ(reference.reason, Reason::none) << f;
    tip_most =
        std::max(tip_most, (result.frames[f].tip_m - reference.transform.translation).norm());
  }
  const double rms_most = result.rms_max_m;
  std::printf("  %zu frames: rms at most %.3f mm, tip within %.4f mm\n", result.frames.size(),
              1e3 * rms_most, 1e3 * tip_most);
  EXPECT_LE(rms_most, 0.0002);
  EXPECT_LE(tip_most, 0.001);
}

INSTANTIATE_TEST_SUITE_P(Trials, ProbePoints,
                         testing::Values("kinematics_racing_probing_acromion_R.c3d",
                                         "kinematics_racing_probing_medial_epicondyle_R.c3d"));

}  // namespace
}  // namespace glint
