#include "platform/lab/experiments/noise_experiment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "kernels/pose/correspond.hpp"
#include "kernels/pose/decide_labeling.hpp"
#include "platform/lab/experiments/estimator_settings.hpp"
#include "platform/lab/experiments/noise_graph.hpp"
#include "platform/lab/experiments/noisy_frame.hpp"
#include "platform/runtime/session/gross.hpp"

namespace glint {
namespace {

constexpr int k_noise_frames = 100'000;
constexpr int k_noise_frames_quick = 200;
constexpr int k_restarted_frames = 10'000;
constexpr int k_frames_per_piece = 10'000;
constexpr double k_pixel_sigma_px = 0.1;
constexpr std::array k_noises_m = {0.0, 0.001, 0.002, 0.003, 0.005};

enum class Knowledge { nothing, prior };

struct NoiseCase {
  const PointTool& tool;
  double sigma_m;
  int strays;
  Knowledge knowledge;
};

ObservationNoise noise_of(const NoiseCase& c) { return {k_pixel_sigma_px, c.sigma_m}; }

std::string name_of(const NoiseCase& c) {
  std::array<char, 96> text;
  std::snprintf(text.data(), text.size(), "%s %.0f mm, %d strays%s", c.tool.name.c_str(),
                1e3 * c.sigma_m, c.strays, c.knowledge == Knowledge::prior ? ", prior" : "");
  return text.data();
}

struct NoiseTally {
  std::int64_t frames = 0, found = 0, wrong = 0, gross = 0;
  std::int64_t hypotheses = 0, hypotheses_most = 0, full = 0;

  void add(const NoiseTally& other) {
    frames += other.frames;
    found += other.found;
    wrong += other.wrong;
    gross += other.gross;
    hypotheses += other.hypotheses;
    hypotheses_most = std::max(hypotheses_most, other.hypotheses_most);
    full += other.full;
  }
  void add(const NoiseCase& c, const PointView& view, const Pose& truth, const Labeling& labeling,
           const Pose& pose, double tip_sigma_m) {
    ++found;
    const Tool& tool = c.tool.tool;
    bool other = false;
    for (int i = 0; i < tool.marker_count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      other = other || (labeling.marker[at] >= 0 && labeling.marker[at] != view.truth[at]);
    }
    wrong += other ? 1 : 0;
    const double tip_m = (pose * tool.tip_m - truth * tool.tip_m).norm();
    gross += is_gross({tip_m, rotation_between_rad(pose, truth), tip_sigma_m, other}) ? 1 : 0;
  }
};

struct NoiseBars {
  Bar found, wrong, gross;
};

// Of each in 100,000 frames.
NoiseBars bars_of(const NoiseCase& c) {
  NoiseBars bars{Bar::none(), Bar::at_most(0), Bar::none()};
  if (c.knowledge == Knowledge::prior) {
    bars.found = Bar::at_least(99.99);
    bars.gross = Bar::at_most(0);
  } else if (c.tool.name == "8700339") {
    bars.found = Bar::at_least(99.9);
    bars.gross = Bar::at_most(c.sigma_m <= 0.002 ? 0 : 20);
  } else {
    bars.found = Bar::at_least(c.sigma_m <= 0.003 ? 99.9 : 99.5);
    bars.wrong = Bar::none();
  }
  return bars;
}

ExperimentCase case_of(const NoiseCase& c, const std::string& method, const NoiseTally& tally,
                       bool judged) {
  const NoiseBars bars = judged ? bars_of(c) : NoiseBars{};
  const auto frames = static_cast<double>(tally.frames);
  return {name_of(c),
          method,
          tally.frames,
          {{"found", "%", 100 * static_cast<double>(tally.found) / frames, bars.found},
           {"wrong", "", static_cast<double>(tally.wrong), bars.wrong},
           {"gross", "", static_cast<double>(tally.gross), bars.gross},
           {"hypotheses", "", static_cast<double>(tally.hypotheses) / frames, {}},
           {"hypotheses_most", "", static_cast<double>(tally.hypotheses_most), {}},
           {"search_full", "", static_cast<double>(tally.full), {}}}};
}

struct Tallies {
  NoiseTally glint, svd;
};

void try_frame(const NoiseCase& c, const NoisyFrame& frame, const EstimatorSettings& settings,
               CorrespondScratch& scratch, Tallies& tallies) {
  const bool predicted = c.knowledge == Knowledge::prior;
  CorrespondSettings gated = settings.correspond;
  gated.focal_px = 253;
  gated.pixel_sigma_px = k_pixel_sigma_px;
  gated.range_sigma_m = std::sqrt(noise_of(c).variance().range_m2);
  // The limit of the rms is three sigmas of the declared noise, as the settings' own is.
  gated.max_rms_m = std::max(gated.max_rms_m, 3 * gated.range_sigma_m);
  Labelings labelings;
  (void)propose_labelings(frame.view.markers, c.tool.tool, gated,
                          predicted ? &frame.prior.T_camera_tool : nullptr, scratch, labelings);
  for (NoiseTally* tally : {&tallies.glint, &tallies.svd}) {
    ++tally->frames;
    tally->hypotheses += labelings.hypotheses;
    tally->hypotheses_most = std::max<std::int64_t>(tally->hypotheses_most, labelings.hypotheses);
    tally->full += labelings.reason == Reason::search_full ? 1 : 0;
  }
  const DecidedLabeling decided =
      decide_labeling(frame.view.markers, frame.view.sights, c.tool.tool, labelings,
                      predicted ? &frame.prior : nullptr, settings.refine);
  if (decided.chosen >= 0) {
    tallies.glint.add(c, frame.view, frame.truth,
                      labelings.items[static_cast<std::size_t>(decided.chosen)],
                      decided.pose.T_camera_tool,
                      std::sqrt(decided.pose.covariance.topLeftCorner<3, 3>().trace()));
  }
  if (labelings.count > 0) {
    tallies.svd.add(c, frame.view, frame.truth, labelings.items[0],
                    labelings.items[0].T_camera_tool, 0);  // it states no covariance
  }
}

std::vector<NoiseCase> cases_of(const PointTool& ndi, const PointTool& pointer) {
  std::vector<NoiseCase> cases;
  for (const int strays : {0, 5, 20}) {
    for (const double sigma_m : k_noises_m) {
      cases.push_back({ndi, sigma_m, strays, Knowledge::nothing});
      cases.push_back({pointer, sigma_m, strays, Knowledge::nothing});
      cases.push_back({ndi, sigma_m, strays, Knowledge::prior});
    }
  }
  return cases;
}

struct GraphRow {
  const char* name;
  GraphStart start;
  bool oracle;
  int frames;
  Bar fresh;
};

// The shipped graph with its built-in settings, 5 mm, 20 strays. The oracle declares the true
// noise; a new tracker may have one point less fresh frames than the oracle's.
void add_graph_rows(const PointTool& ndi, const CaseOptions& options, CaseList& list) {
  double oracle_fresh = 0;
  for (const GraphRow& row :
       {GraphRow{"one tool in a moving hand", GraphStart::once, false, k_noise_frames,
                 Bar::at_least(99.99)},
        GraphRow{"a new tracker a frame, oracle", GraphStart::each_frame, true, k_restarted_frames,
                 Bar::none()},
        GraphRow{"a new tracker a frame", GraphStart::each_frame, false, k_restarted_frames, {}}}) {
    const int frames = options.quick ? std::min(k_noise_frames_quick, row.frames) : row.frames;
    const GraphNoiseTally tally = options.piece([&] {
      return run_noise_graph({ndi, {k_pixel_sigma_px, 0.005}, 20, row.start, row.oracle}, frames,
                             options.seed);
    });
    const double fresh =
        100 * static_cast<double>(tally.fresh) / static_cast<double>(tally.trackable);
    if (row.oracle) oracle_fresh = fresh;
    const bool compared = row.start == GraphStart::each_frame && !row.oracle;
    const Bar bar = compared ? Bar::at_least(oracle_fresh - 1) : row.fresh;
    std::vector<Figure> figures = {{"fresh", "%", fresh, options.quick ? Bar::none() : bar},
                                   {"gross", "", static_cast<double>(tally.gross),
                                    options.quick ? Bar::none() : Bar::at_most(0)}};
    for (std::size_t reason = 0; reason < tally.missed.size(); ++reason) {
      if (tally.missed[reason] > 0)
        figures.push_back({"missed_" + std::string(name_of(static_cast<Reason>(reason))), "",
                           static_cast<double>(tally.missed[reason])});
    }
    list.cases.push_back({std::string("8700339 5 mm, 20 strays, ") + row.name, "graph",
                          tally.trackable, std::move(figures)});
  }
}

}  // namespace

CaseList run_noise(const CaseOptions& options) {
  const EstimatorSettings settings;
  const Camera camera = ahat_ray_table();
  const PointTool ndi = ndi_8700339(), pointer = sttar_pointer();
  const std::vector<NoiseCase> cases = cases_of(ndi, pointer);
  const int frames = options.quick ? k_noise_frames_quick : k_noise_frames;
  const auto scratch = std::make_unique<CorrespondScratch>();
  const auto frame = std::make_unique<NoisyFrame>();
  CaseList list{"noise", {}, {}};
  for (std::size_t k = 0; k < cases.size(); ++k) {
    Tallies tallies;
    for (int first = 0; first < frames; first += k_frames_per_piece) {
      const Tallies piece = options.piece([&] {
        Tallies some;
        for (int f = first; f < std::min(first + k_frames_per_piece, frames); ++f) {
          SampleNumbers numbers(options.seed, 1000 + k, static_cast<std::uint64_t>(f));
          draw_frame({cases[k].tool, noise_of(cases[k]), cases[k].strays}, camera, numbers, *frame);
          try_frame(cases[k], *frame, settings, *scratch, some);
        }
        return some;
      });
      tallies.glint.add(piece.glint);
      tallies.svd.add(piece.svd);
    }
    list.cases.push_back(case_of(cases[k], "glint", tallies.glint, !options.quick));
    list.cases.push_back(case_of(cases[k], "svd", tallies.svd, false));
    if (options.progress) options.progress(static_cast<int>(k) + 1, static_cast<int>(cases.size()));
  }
  add_graph_rows(ndi, options, list);
  return list;
}

}  // namespace glint
