#include "platform/lab/experiments/centroid_experiment.hpp"

#include <cmath>
#include <map>

#include "platform/lab/experiments/centroid_cases.hpp"
#include "platform/lab/experiments/centroid_methods.hpp"
#include "platform/tools/report/plots.hpp"

namespace glint {
namespace {

constexpr int k_spheres = 2000, k_spheres_quick = 150;
// Limits of the ratio of rms error to stated sigma.
constexpr double k_ratio_max = 1.4, k_ratio_min = 0.7;
constexpr double k_corrected_px = 0.02;  // limit of the bias after sphere correction
constexpr double k_flagged_min = 0.95;

// Error statistics of one method on one case.
struct Errors {
  Vector2 sum = Vector2::Zero();
  double squares = 0;
  std::int64_t n = 0;

  void add(const Vector2& error) {
    sum += error;
    squares += error.squaredNorm();
    ++n;
  }
  [[nodiscard]] double rms() const { return std::sqrt(squares / (2 * per())); }  // per axis
  [[nodiscard]] double bias() const { return (sum / per()).norm(); }
  [[nodiscard]] double per() const { return n > 0 ? static_cast<double>(n) : 1; }
};

struct Outcome {
  Errors raw, corrected, weighted, binary, baseline;
  double variance_sum = 0;  // stated, sum of both axes
  double range_squares = 0, range_variance_sum = 0, range_sum = 0;
  std::int64_t markers = 0, flagged = 0;
};

void add(Outcome& outcome, const CentroidCase& one, const SphereImages::Truth& truth,
         const CentroidMethods::Located& located) {
  const Blob& blob = located.blob;
  outcome.raw.add(blob.centroid_px - truth.centre_px);
  outcome.weighted.add(located.weighted - truth.centre_px);
  outcome.binary.add(located.binary - truth.centre_px);
  outcome.variance_sum += double{blob.variance_px2[0]} + double{blob.variance_px2[1]};
  outcome.flagged += (blob.flags & one.flag) != 0 ? 1 : 0;
  if (!located.marker || (located.marker->flags & k_marker_no_depth) != 0) return;
  const Marker& marker = *located.marker;
  outcome.corrected.add(marker.centroid_px - truth.centre_px);
  const double error = marker.surface_range_m - (truth.centre_m.norm() - one.setting.radius_m);
  outcome.range_sum += error;
  outcome.range_squares += error * error;
  outcome.range_variance_sum += double{marker.range_sigma_m} * double{marker.range_sigma_m};
  ++outcome.markers;
}

Outcome measure(const CentroidCase& one, int spheres, std::uint64_t seed) {
  SphereImages pictures(one.setting, seed);
  CentroidMethods methods(pictures.camera(), one.stated,
                          {one.setting.radius_m, MarkerShape::sphere});
  Outcome outcome;
  FrameBuffer buffer;
  for (int i = 0; i < spheres; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    const SphereImages::Truth truth = pictures.render(number, buffer);
    const Frame frame = buffer.view({}, {}, static_cast<std::uint32_t>(i));
    if (const auto located = methods.locate(frame, truth.centre_px)) {
      add(outcome, one, truth, *located);
    }
    if (const auto place = methods.locate_by_baseline(frame, truth.centre_px)) {
      outcome.baseline.add(*place - truth.centre_px);
    }
  }
  return outcome;
}

double share(std::int64_t part, std::int64_t of) {
  return of > 0 ? static_cast<double>(part) / static_cast<double>(of) : 0;
}

ExperimentCase glint_case(const CentroidCase& one, const Outcome& outcome, int spheres) {
  const double rms = outcome.raw.rms();
  const double sigma = std::sqrt(outcome.variance_sum / (2.0 * static_cast<double>(outcome.raw.n)));
  ExperimentCase out{one.name, "glint", spheres, {}};
  const Bar bar = one.rms_max_px > 0 ? Bar::at_most(one.rms_max_px) : Bar::none();
  out.figures.push_back({"rms", "px", rms, bar});
  out.figures.push_back({"sigma", "px", sigma});
  out.figures.push_back({"rms_over_sigma", "", rms / sigma, Bar::at_most(k_ratio_max)});
  if (one.whole) {
    out.figures.push_back({"sigma_over_rms", "", sigma / rms, Bar::at_most(1 / k_ratio_min)});
  } else {
    out.figures.push_back(
        {"flagged", "", share(outcome.flagged, outcome.raw.n), Bar::at_least(k_flagged_min)});
  }
  out.figures.push_back({"found", "", share(outcome.raw.n, spheres)});
  return out;
}

ExperimentCase range_case(const CentroidCase& one, const Outcome& outcome) {
  const auto n = static_cast<double>(outcome.markers);
  const double rms_mm = 1e3 * std::sqrt(outcome.range_squares / n);
  const double sigma_mm = 1e3 * std::sqrt(outcome.range_variance_sum / n);
  return {one.name,
          "glint, range",
          outcome.markers,
          {{"rms", "mm", rms_mm},
           {"bias", "mm", 1e3 * outcome.range_sum / n},
           {"sigma", "mm", sigma_mm},
           {"rms_over_sigma", "", rms_mm / sigma_mm}}};
}

ExperimentCase other_case(const CentroidCase& one, const char* method, const Errors& errors,
                          int spheres) {
  ExperimentCase out{one.name, method, spheres, {}};
  if (errors.n > 0) out.figures.push_back({"rms", "px", errors.rms()});
  out.figures.push_back({"found", "", share(errors.n, spheres)});
  return out;
}

ExperimentCase off_axis_case(const CentroidCase& one, const Outcome& outcome) {
  return {one.name,
          "glint",
          outcome.corrected.n,
          {{"bias_before", "px", outcome.raw.bias()},
           {"bias", "px", outcome.corrected.bias(), Bar::at_most(k_corrected_px)},
           {"rms", "px", outcome.corrected.rms(), Bar::at_most(0.03)}}};
}

// rms by diameter: a line per method, a plot per kind of sphere.
class Plots {
 public:
  void add(const CentroidCase& one, const Outcome& outcome) {
    const std::string kind = one.name.substr(0, one.name.rfind(','));
    add(kind, "Glint", one, outcome.raw);
    add(kind, "weight I - threshold", one, outcome.weighted);
    add(kind, "binary", one, outcome.binary);
    add(kind, "baseline", one, outcome.baseline);
  }
  [[nodiscard]] std::vector<PlotFile> files_in(const std::string& folder) const {
    std::vector<PlotFile> files;
    for (const auto& [kind, lines] : kinds_) {
      files.push_back(
          {folder + "/centroid_" + std::to_string(files.size() + 1) + ".svg",
           line_plot({"Centroids: " + kind, "diameter [px]", "rms an axis [px]"}, lines)});
    }
    return files;
  }

 private:
  void add(const std::string& kind, const std::string& method, const CentroidCase& one,
           const Errors& errors) {
    if (errors.n == 0) return;
    std::vector<LineSeries>& lines = kinds_[kind];
    for (LineSeries& line : lines) {
      if (line.name != method) continue;
      line.points.emplace_back(one.diameter_px, errors.rms());
      return;
    }
    lines.push_back({method, {{one.diameter_px, errors.rms()}}});
  }
  std::map<std::string, std::vector<LineSeries>> kinds_;
};

}  // namespace

CaseList run_centroid_experiment(const CaseOptions& options) {
  const int spheres = options.quick ? k_spheres_quick : k_spheres;
  const auto sized = sized_cases(), disturbed = disturbed_cases(), off_axis = off_axis_cases();
  const int total = spheres * static_cast<int>(sized.size() + disturbed.size() + off_axis.size());
  int done = 0;
  const auto measured = [&](const CentroidCase& one) {
    const Outcome outcome = options.piece([&] { return measure(one, spheres, options.seed); });
    done += spheres;
    if (options.progress) options.progress(done, total);
    return outcome;
  };
  CaseList list{"centroid", {}, {}};
  Plots plots;
  for (const CentroidCase& one : sized) {
    const Outcome outcome = measured(one);
    plots.add(one, outcome);
    list.cases.push_back(glint_case(one, outcome, spheres));
    list.cases.push_back(other_case(one, "weight I - threshold", outcome.weighted, spheres));
    list.cases.push_back(other_case(one, "binary", outcome.binary, spheres));
    list.cases.push_back(other_case(one, "baseline", outcome.baseline, spheres));
    if (outcome.markers > 0) list.cases.push_back(range_case(one, outcome));
  }
  for (const CentroidCase& one : disturbed) {
    list.cases.push_back(glint_case(one, measured(one), spheres));
  }
  for (const CentroidCase& one : off_axis) list.cases.push_back(off_axis_case(one, measured(one)));
  list.plots = plots.files_in(options.out);
  return list;
}

}  // namespace glint
