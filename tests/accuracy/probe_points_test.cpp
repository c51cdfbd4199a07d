// A real hand-held probe of six markers, a nearly symmetric grid, as unlabelled points. It must be
// found in every frame, at the same position as with the labels of the motion-capture system.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "kernels/pose/rigid_fit.hpp"
#include "platform/formats/c3d_reader.hpp"
#include "platform/formats/points_csv.hpp"
#include "platform/tools/inspect/replay_points.hpp"
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

using Frames = std::vector<std::vector<Vector3>>;  // six markers each, NaN where missing

Frames frames_of(const C3dTrial& trial) {
  Frames frames;
  for (std::size_t f = 0; f < trial.frames.size(); ++f) frames.push_back(probe_markers(trial, f));
  return frames;
}

// Writes the trial as a user's file: rows shuffled within their frame, no labels.
void write_shuffled(const Frames& frames, double rate_hz, const std::string& path) {
  test::Random random(1);
  std::ofstream out(path);
  out << "time_s,x_m,y_m,z_m\n";
  out.precision(9);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    std::vector<Vector3> markers = frames[f];
    for (std::size_t k = markers.size(); k > 1; --k) {
      std::swap(markers[k - 1],
                markers[static_cast<std::size_t>(random.below(static_cast<int>(k)))]);
    }
    for (const Vector3& m : markers) {
      if (!std::isfinite(m.sum())) continue;
      out << static_cast<double>(f) / rate_hz << ',' << m.x() << ',' << m.y() << ',' << m.z()
          << '\n';
    }
  }
}

// Writes the probe as a tool file with the tip at its origin.
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

constexpr std::array k_trials = {"kinematics_racing_probing_acromion_R.c3d",
                                 "kinematics_racing_probing_medial_epicondyle_R.c3d"};
constexpr double k_wrong_m = 0.010;

struct Counts {
  int frames = 0, solved = 0, ambiguous = 0, wrong = 0;
  double tip_max_m = 0, rms_max_m = 0;

  void operator+=(const Counts& more) {
    frames += more.frames;
    solved += more.solved;
    ambiguous += more.ambiguous;
    wrong += more.wrong;
    tip_max_m = std::max(tip_max_m, more.tip_max_m);
    rms_max_m = std::max(rms_max_m, more.rms_max_m);
  }
};

// Replays the unlabelled points and compares with the fit by the motion-capture labels.
Counts replayed(const Tool& probe, const Frames& frames, double rate_hz) {
  const std::string csv = testing::TempDir() + "probe_points_" + std::to_string(getpid()) + ".csv";
  write_shuffled(frames, rate_hz, csv);
  const std::string tool = csv + ".toml";
  write_tool(probe, tool);
  const PointsResult result = replay_points(csv, tool);
  std::filesystem::remove(csv);
  std::filesystem::remove(tool);
  Counts counts;
  EXPECT_EQ(result.frames.size(), frames.size());
  counts.frames = static_cast<int>(result.frames.size());
  counts.ambiguous = static_cast<int>(result.ambiguous);
  counts.rms_max_m = result.rms_max_m;
  for (std::size_t f = 0; f < result.frames.size(); ++f) {
    if (!result.frames[f].solved) continue;
    const RigidFit reference = labelled_fit(probe, frames[f]);
    const double tip_m = (result.frames[f].tip_m - reference.transform.translation).norm();
    ++counts.solved;
    counts.wrong += tip_m > k_wrong_m ? 1 : 0;
    counts.tip_max_m = std::max(counts.tip_max_m, tip_m);
  }
  return counts;
}

void print(const char* what, const Counts& counts) {
  std::printf("  %s: %d frames, %d solved, %d ambiguous (%.1f %%), %d wrong\n", what, counts.frames,
              counts.solved, counts.ambiguous, 100.0 * counts.ambiguous / counts.frames,
              counts.wrong);
}

class ProbePoints : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(data_folder() + k_trials[0]))
      GTEST_SKIP() << "no " << data_folder() << k_trials[0] << "; set GLINT_TEST_DATA";
    probe_ = probe_from(data_folder() + "ktk_probe_geometry.csv");
    ASSERT_EQ(probe_.marker_count, 6);
    for (const char* name : k_trials) trials_.push_back(C3dFile(data_folder() + name).read());
    for (const C3dTrial& trial : trials_) ASSERT_EQ(trial.frames.size(), 140u);
  }

  // Both trials, with `change` applied to each frame.
  template <class Change>
  [[nodiscard]] Counts with(const Change& change) const {
    Counts counts;
    for (const C3dTrial& trial : trials_) {
      Frames frames = frames_of(trial);
      for (std::vector<Vector3>& markers : frames) change(markers);
      counts += replayed(probe_, frames, trial.rate_hz);
    }
    return counts;
  }

  // Every choice of `hidden` of the six markers, the same in every frame.
  [[nodiscard]] Counts with_hidden(int hidden) const {
    Counts counts;
    for (unsigned mask = 0; mask < 64; ++mask) {
      if (std::popcount(mask) != hidden) continue;
      counts += with([&](std::vector<Vector3>& markers) {
        for (std::size_t i = 0; i < markers.size(); ++i)
          if ((mask >> i) & 1) markers[i] = Vector3::Constant(NAN);
      });
    }
    return counts;
  }

  Tool probe_;
  std::vector<C3dTrial> trials_;
};

TEST_F(ProbePoints, SixAreSolvedInEveryFrameWhereTheLabelsPutTheTip) {
  const Counts counts = with_hidden(0);
  print("six markers", counts);
  EXPECT_EQ(counts.solved, 280);
  EXPECT_EQ(counts.ambiguous, 0);
  EXPECT_LE(counts.rms_max_m, 0.0002);
  EXPECT_LE(counts.tip_max_m, 0.001);
}

TEST_F(ProbePoints, FiveAreRightOrAmbiguous) {
  const Counts counts = with_hidden(1);
  print("each five", counts);
  EXPECT_EQ(counts.wrong, 0);
  EXPECT_LE(counts.ambiguous, 0.2 * counts.frames);
}

TEST_F(ProbePoints, FourAreRightOrAmbiguous) {
  const Counts counts = with_hidden(2);
  print("each four", counts);
  EXPECT_EQ(counts.wrong, 0);
  EXPECT_GT(counts.solved, 0);
}

// Random missing markers, a random rotation and translation, additional noise, and reversed time.
TEST_F(ProbePoints, AreRightOrAmbiguousWhenHiddenByChanceTurnedAndNoisy) {
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
    for (const int hidden_max : {1, 2}) {
      test::Random random(seed);
      const Pose turned{random.rotation(), random.vector(1)};
      Counts counts = with([&](std::vector<Vector3>& markers) {
        for (Vector3& m : markers) m = turned * m + random.vector(0.0001);
        for (int hidden = random.below(hidden_max + 1); hidden > 0; --hidden)
          markers[static_cast<std::size_t>(random.below(6))] = Vector3::Constant(NAN);
      });
      print(hidden_max == 1 ? "at most one hidden by chance" : "at most two hidden by chance",
            counts);
      EXPECT_EQ(counts.wrong, 0) << "seed " << seed;
    }
  }
  for (const C3dTrial& trial : trials_) {
    Frames frames = frames_of(trial);
    std::reverse(frames.begin(), frames.end());
    EXPECT_EQ(replayed(probe_, frames, trial.rate_hz).wrong, 0);
  }
}

// Single frames are ambiguous at the declared noise. Frames far apart in time are decided
// independently.
TEST_F(ProbePoints, FramesFarApartAreDecidedAlone) {
  Counts counts;
  for (const C3dTrial& trial : trials_) counts += replayed(probe_, frames_of(trial), 2);
  print("six markers, 0.5 s apart", counts);
  EXPECT_EQ(counts.wrong, 0);
  EXPECT_EQ(counts.ambiguous, counts.frames);
}

}  // namespace
}  // namespace glint
