#include "platform/lab/experiments/marker_mocap.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "kernels/pose/correspond.hpp"
#include "platform/formats/c3d_reader.hpp"
#include "platform/input_error.hpp"
#include "platform/sim/random.hpp"
#include "platform/tools/calibrate/frame_labels.hpp"
#include "platform/tools/calibrate/tool_geometry.hpp"
#include "platform/tools/report/plots.hpp"

namespace glint {
namespace {

constexpr double k_geometry_max_mm = 0.2;
constexpr double k_tip_axis_rms_max_mm = 0.7;

// Reads the published probe geometry; a row "ProbeTip" is its origin.
Tool published_probe(const std::string& path) {
  Tool tool;
  std::ifstream in(path);
  int number = 0;
  for (std::string line; std::getline(in, line); ++number) {
    if (line.rfind("Probe", 0) != 0 || line.rfind("ProbeTip", 0) == 0) continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream row(line);
    std::string name;
    Vector3 marker;
    row >> name >> marker.x() >> marker.y() >> marker.z();
    if (!row || tool.marker_count == k_markers_per_tool_max) {
      throw InputError(path + ":" + std::to_string(number + 1) +
                       ": no marker; expected name,x,y,z, at most " +
                       std::to_string(k_markers_per_tool_max));
    }
    tool.markers_m[static_cast<std::size_t>(tool.marker_count++)] = marker;
  }
  if (prepare_tool(tool) == Reason::none) return tool;
  throw InputError(path + ": " + std::to_string(tool.marker_count) +
                   " markers; expected rows Probe1,x,y,z .. of 3 or more that determine a pose");
}

// The trial's probe markers without labels, in random order in each frame.
std::vector<PointFrame> unlabelled(const std::string& path, int markers, std::uint64_t seed) {
  const C3dTrial trial = C3dFile(path).read();
  std::vector<PointFrame> frames;
  for (std::size_t f = 0; f < trial.frames.size(); ++f) {
    PointFrame frame{Time{static_cast<std::int64_t>(1e9 * static_cast<double>(f) / trial.rate_hz)},
                     {}};
    for (int i = 1; i <= markers; ++i) {
      const int index = trial.index_of("Probe" + std::to_string(i));
      if (index < 0) throw InputError(path + ": no point Probe" + std::to_string(i));
      const Vector3& point = trial.frames[f][static_cast<std::size_t>(index)];
      if (point.allFinite()) frame.points_m.push_back(point);
    }
    const sim::RandomKey key{seed, sim::Stream::hand, f};
    for (std::size_t k = frame.points_m.size(); k > 1; --k) {
      std::swap(frame.points_m[k - 1], frame.points_m[key.bits(k) % k]);
    }
    if (!frame.points_m.empty()) frames.push_back(frame);
  }
  return frames;
}

Tool found_tool(const ToolGeometry& geometry) {
  Tool tool;
  for (const Vector3& marker : geometry.markers_m) {
    tool.markers_m[static_cast<std::size_t>(tool.marker_count++)] = marker;
  }
  (void)prepare_tool(tool);
  return tool;
}

// The published probe fitted to the found markers, without given correspondences.
struct Overlay {
  Labeling labeling;
  std::vector<double> errors_mm;  // per published marker that was found
};

Overlay overlay(const Tool& published, const Tool& found, const std::string& what) {
  const std::vector<Vector3> markers(found.markers_m.begin(),
                                     found.markers_m.begin() + found.marker_count);
  auto scratch = std::make_unique<CorrespondScratch>();
  auto labelings = std::make_unique<Labelings>();
  propose_labelings(markers_from_points(markers), as_points(published), settings_for_points(),
                    nullptr, *scratch, *labelings);
  if (labelings->count == 0) {
    throw InputError(what + ": the found markers differ from the published probe");
  }
  Overlay result{labelings->items[0], {}};
  for (int i = 0; i < published.marker_count; ++i) {
    const int which = result.labeling.marker[static_cast<std::size_t>(i)];
    if (which < 0) continue;
    const Vector3 laid =
        result.labeling.T_camera_tool * published.markers_m[static_cast<std::size_t>(i)];
    result.errors_mm.push_back(1e3 * (laid - markers[static_cast<std::size_t>(which)]).norm());
  }
  return result;
}

// Returns the tip's position in each frame in which the tool was found.
std::vector<Vector3> tips(std::span<const PointFrame> frames, const Tool& tool,
                          const Vector3& tip_m, const ToolGeometry& geometry) {
  std::vector<Vector3> places;
  for (const Segment& segment : segments_of(frames, ToolGeometrySettings{}.step_max_m)) {
    for (const Labeling& label : label_segment(frames, segment, tool, 1.2 * geometry.noise_m)) {
      if (label.count >= 3) places.push_back(label.T_camera_tool * tip_m);
    }
  }
  return places;
}

// Scatter of positions about their mean, in the frame of the room.
struct Scatter {
  std::vector<double> distances_mm;
  Vector3 axis_rms_mm = Vector3::Zero();
};

Scatter scatter_of(const std::vector<Vector3>& places) {
  const auto count = static_cast<double>(places.size());
  Vector3 mean = Vector3::Zero();
  for (const Vector3& place : places) mean += place / count;
  Scatter scatter;
  for (const Vector3& place : places) {
    scatter.distances_mm.push_back(1e3 * (place - mean).norm());
    scatter.axis_rms_mm += 1e6 * (place - mean).cwiseAbs2() / count;
  }
  scatter.axis_rms_mm = scatter.axis_rms_mm.cwiseSqrt();
  return scatter;
}

double rms(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

LineSeries series_of(const std::string& name, const std::vector<double>& values) {
  LineSeries series{name, {}};
  for (std::size_t i = 0; i < values.size(); ++i) {
    series.points.emplace_back(static_cast<double>(i), values[i]);
  }
  return series;
}

enum class Judged { no, yes };

ExperimentCase scatter_case(const std::string& name, const char* method, const Scatter& scatter,
                            std::size_t frames, Judged judged) {
  const bool bars = judged == Judged::yes;
  const auto lost = static_cast<double>(frames - scatter.distances_mm.size());
  return {name,
          method,
          static_cast<std::int64_t>(scatter.distances_mm.size()),
          {{"tip_rms_worst_axis", "mm", scatter.axis_rms_mm.maxCoeff(),
            bars ? Bar::at_most(k_tip_axis_rms_max_mm) : Bar::none()},
           {"tip_rms_3d", "mm", scatter.axis_rms_mm.norm()},
           {"frames_not_found", "", lost, bars ? Bar::at_most(0) : Bar::none()}}};
}

std::vector<std::string> trials_in(const std::string& folder) {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.find("probing") != std::string::npos && entry.path().extension() == ".c3d") {
      paths.push_back(entry.path().string());
    }
  }
  std::sort(paths.begin(), paths.end());
  if (!paths.empty()) return paths;
  throw InputError(folder + ": no trial; expected *probing*.c3d beside ktk_probe_geometry.csv");
}

}  // namespace

CaseList run_marker_mocap(const CaseOptions& options) {
  const std::string nested = options.data + "/marker_mocap";
  const std::string folder = std::filesystem::is_directory(nested) ? nested : options.data;
  const std::vector<std::string> paths = trials_in(folder);
  const Tool published = published_probe(folder + "/ktk_probe_geometry.csv");

  std::vector<std::vector<PointFrame>> trials;
  std::vector<PointFrame> all;
  for (const std::string& path : paths) {
    trials.push_back(unlabelled(path, published.marker_count, options.seed));
    all.insert(all.end(), trials.back().begin(), trials.back().end());
  }
  const ToolGeometry geometry = calibrate_tool(all, {}, folder);
  const Tool tool = found_tool(geometry);
  const Overlay laid = overlay(published, tool, folder);

  CaseList list{"marker_mocap", {}, {}};
  const double missing = published.marker_count - static_cast<double>(laid.errors_mm.size());
  list.cases.push_back({"probe geometry",
                        "glint",
                        geometry.frames_used,
                        {{"marker_error_largest", "mm",
                          *std::max_element(laid.errors_mm.begin(), laid.errors_mm.end()),
                          Bar::at_most(k_geometry_max_mm)},
                         {"marker_error_rms", "mm", rms(laid.errors_mm)},
                         {"markers_not_found", "", missing, Bar::at_most(0)},
                         {"noise", "mm", 1e3 * geometry.noise_m}}});
  const Vector3 tip = laid.labeling.T_camera_tool * Vector3::Zero();
  std::vector<LineSeries> plot;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const std::string name = std::filesystem::path(paths[i]).stem().string();
    const Scatter found = scatter_of(tips(trials[i], tool, tip, geometry));
    const Scatter given = scatter_of(tips(trials[i], published, Vector3::Zero(), geometry));
    list.cases.push_back(scatter_case(name, "glint", found, trials[i].size(), Judged::yes));
    list.cases.push_back(
        scatter_case(name, "published geometry", given, trials[i].size(), Judged::no));
    plot.push_back(series_of(name, found.distances_mm));
  }
  list.plots.push_back(
      {options.out + "/marker_mocap_tip.svg",
       line_plot({"Tip on a landmark, from its mean", "frame", "distance [mm]"}, plot)});
  return list;
}

}  // namespace glint
