#include "platform/lab/experiments/cis_pivot.hpp"

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "kernels/pose/rigid_fit.hpp"
#include "platform/input_error.hpp"
#include "platform/lab/experiments/cis_files.hpp"
#include "platform/tools/calibrate/pivot.hpp"

namespace glint {
namespace {

constexpr double k_mean_error_max_mm = 0.02;

std::string stem(const std::string& path, const std::string& ending) {
  const std::string name = std::filesystem::path(path).filename().string();
  return name.substr(0, name.size() - ending.size());
}

void require(const CisFile& file, std::size_t counts) {
  if (file.counts.size() >= counts &&
      *std::min_element(file.counts.begin(), file.counts.end()) >= 0)
    return;
  throw InputError(file.path + ":1: " + std::to_string(file.counts.size()) + " counts; expected " +
                   std::to_string(counts));
}

std::vector<Vector3> transformed(const Pose& T, std::vector<Vector3> points) {
  for (Vector3& point : points) point = T * point;
  return points;
}

Pose fitted(std::span<const Vector3> model, std::span<const Vector3> measured,
            const std::string& path) {
  const RigidFit fit = fit_rigid(model, measured);
  if (fit.reason == Reason::none) return fit.transform;
  throw InputError(path + ": markers determine no pose (" + std::string(name_of(fit.reason)) +
                   "); expected 3 or more that are not collinear");
}

// Pointer poses from its markers. The first frame's markers, relative to their mean, are the
// geometry, as in the course.
std::vector<TimedPose> poses_of(const std::vector<std::vector<Vector3>>& frames,
                                const std::string& path) {
  std::vector<Vector3> model = frames.front();
  Vector3 mean = Vector3::Zero();
  for (const Vector3& point : model) mean += point / static_cast<double>(model.size());
  for (Vector3& point : model) point -= mean;
  std::vector<TimedPose> poses;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    poses.push_back({Time{static_cast<std::int64_t>(i)}, fitted(model, frames[i], path)});
  }
  return poses;
}

std::vector<std::vector<Vector3>> frames_em(const std::string& path) {
  const CisFile file = load_cis(path);
  require(file, 2);
  const auto markers = static_cast<std::size_t>(file.counts[0]);
  std::vector<std::vector<Vector3>> frames;
  for (std::size_t f = 0; f < static_cast<std::size_t>(file.counts[1]); ++f) {
    frames.push_back(file.points_m(f * markers, markers));
  }
  return frames;
}

// Pointer markers of the optical tracker, in the frame of the base measured at the same time.
std::vector<std::vector<Vector3>> frames_optical(const std::string& path,
                                                 const std::string& base_path) {
  const CisFile file = load_cis(path), base_file = load_cis(base_path);
  require(file, 3);
  const auto base_count = static_cast<std::size_t>(file.counts[0]);
  const auto markers = static_cast<std::size_t>(file.counts[1]);
  const std::vector<Vector3> base = base_file.points_m(0, base_count);
  std::vector<std::vector<Vector3>> frames;
  for (std::size_t f = 0; f < static_cast<std::size_t>(file.counts[2]); ++f) {
    const std::size_t first = f * (base_count + markers);
    const Pose T_base_tracker = fitted(file.points_m(first, base_count), base, path);
    frames.push_back(transformed(T_base_tracker, file.points_m(first + base_count, markers)));
  }
  return frames;
}

struct TipErrors {
  std::vector<double> mm;
  [[nodiscard]] double mean() const {
    return std::accumulate(mm.begin(), mm.end(), 0.0) / static_cast<double>(mm.size());
  }
  [[nodiscard]] double most() const { return *std::max_element(mm.begin(), mm.end()); }
};

void judge_pivot(const std::string& name, const std::vector<std::vector<Vector3>>& frames,
                 const Vector3& answer_m, CaseList& list, TipErrors& errors) {
  const PivotResult result = calibrate_pivot(poses_of(frames, name), {}, name);
  errors.mm.push_back(1e3 * (result.post_m - answer_m).norm());
  list.cases.push_back({name,
                        "glint",
                        static_cast<std::int64_t>(frames.size()),
                        {{"post_error", "mm", errors.mm.back()},
                         {"tip_sigma", "mm", 1e3 * result.tip_sigma_m},
                         {"rms", "mm", 1e3 * result.rms_m},
                         {"outliers", "", static_cast<double>(result.outliers)}}});
}

void run_problem_1(const std::string& folder, CaseList& list) {
  const std::string ending = "-empivot.txt";
  TipErrors em, optical;
  for (const std::string& path : cis_paths(folder, ending)) {
    const std::string name = stem(path, ending), start = folder + "/" + name;
    if (!std::filesystem::exists(start + "-output1.txt")) continue;  // a case without an answer
    const CisFile answer = load_cis(start + "-output1.txt");
    judge_pivot(name + " em", frames_em(path), answer.points_m(0, 2)[0], list, em);
    judge_pivot(name + " optical", frames_optical(start + "-optpivot.txt", start + "-calbody.txt"),
                answer.points_m(0, 2)[1], list, optical);
  }
  if (em.mm.empty()) return;
  const auto add = [&](const char* name, const TipErrors& errors) {
    list.cases.push_back({name,
                          "glint",
                          static_cast<std::int64_t>(errors.mm.size()),
                          {{"mean_error", "mm", errors.mean(), Bar::at_most(k_mean_error_max_mm)},
                           {"largest_error", "mm", errors.most()}}});
  };
  add("all em posts", em);
  add("all optical posts", optical);
}

// Returns the markers of a body, then its tip.
std::vector<Vector3> body_of(const std::string& path) {
  const CisFile file = load_cis(path);
  require(file, 1);
  return file.points_m(0, static_cast<std::size_t>(file.counts[0]) + 1);
}

// Pointer tip in body B's frame. A frame's entries after both bodies' markers are dummies.
Vector3 two_body_tip(const std::vector<Vector3>& a, const std::vector<Vector3>& b,
                     std::span<const Vector3> frame, const std::string& path) {
  const std::span<const Vector3> markers_a(a.data(), a.size() - 1),
      markers_b(b.data(), b.size() - 1);
  const Pose T_tracker_a = fitted(markers_a, frame.first(markers_a.size()), path);
  const Pose T_tracker_b =
      fitted(markers_b, frame.subspan(markers_a.size(), markers_b.size()), path);
  return T_tracker_b.inverse() * (T_tracker_a * a.back());
}

void run_problem_3(const std::string& folder, CaseList& list) {
  const std::string ending = "-SampleReadingsTest.txt";
  const std::vector<std::string> paths = cis_paths(folder, ending);
  if (paths.empty()) return;
  const std::vector<Vector3> a = body_of(folder + "/Problem3-BodyA.txt");
  const std::vector<Vector3> b = body_of(folder + "/Problem3-BodyB.txt");
  TipErrors all;
  for (const std::string& path : paths) {
    const std::string name = stem(path, ending);
    if (!std::filesystem::exists(folder + "/" + name + "-Answer.txt")) continue;
    const CisFile answer = load_cis(folder + "/" + name + "-Answer.txt"), readings = load_cis(path);
    require(readings, 2);
    const auto per_frame = static_cast<std::size_t>(readings.counts[0]);
    const auto count = static_cast<std::size_t>(readings.counts[1]);
    if (per_frame < a.size() + b.size() - 2) {
      throw InputError(path + ":1: frames of " + std::to_string(per_frame) +
                       " markers; expected both bodies' " +
                       std::to_string(a.size() + b.size() - 2));
    }
    const std::vector<Vector3> answers = answer.points_m(0, count);
    TipErrors errors;
    for (std::size_t f = 0; f < count; ++f) {
      const std::vector<Vector3> frame = readings.points_m(f * per_frame, per_frame);
      errors.mm.push_back(1e3 * (two_body_tip(a, b, frame, path) - answers[f]).norm());
    }
    all.mm.insert(all.mm.end(), errors.mm.begin(), errors.mm.end());
    list.cases.push_back(
        {name + " two-body tip",
         "glint",
         static_cast<std::int64_t>(count),
         {{"mean_error", "mm", errors.mean()}, {"largest_error", "mm", errors.most()}}});
  }
  if (all.mm.empty()) return;
  list.cases.push_back({"all two-body tips",
                        "glint",
                        static_cast<std::int64_t>(all.mm.size()),
                        {{"mean_error", "mm", all.mean(), Bar::at_most(k_mean_error_max_mm)},
                         {"largest_error", "mm", all.most()}}});
}

}  // namespace

CaseList run_cis_pivot(const CaseOptions& options) {
  CaseList list{"cis_pivot", {}, {}};
  const std::string nested = options.data + "/cis_pivot";
  const std::string folder = std::filesystem::is_directory(nested) ? nested : options.data;
  run_problem_1(folder + "/pa1", list);
  run_problem_3(folder + "/pa3", list);
  if (list.cases.empty()) {
    throw InputError(options.data +
                     ": no case with an answer; expected pa1/*-empivot.txt beside *-output1.txt, "
                     "or pa3/*-SampleReadingsTest.txt beside *-Answer.txt");
  }
  return list;
}

}  // namespace glint
