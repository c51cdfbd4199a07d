#include "platform/tools/reference/find_reference.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "kernels/elementary.hpp"
#include "kernels/registration/judge_links.hpp"
#include "kernels/registration/patch_covariance.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/reference/reference_checks.hpp"

namespace glint {
namespace {

constexpr std::size_t k_coarse_poses_aligned = 8, k_rotated_poses_aligned = 3;
constexpr double k_coarse_apart_m = 0.06;
// Coarse poses are some centimetres off: those with half of the best score are aligned, too.
constexpr double k_coarse_share = 0.5;

Quaternion turn_about_z(double radians) {
  const SineCosine half = sine_cosine(0.5 * radians);
  return {half.cosine, 0, 0, half.sine};
}

// Rotations about the base's own z by eighths: a robot's base is round, and its links are nearly
// symmetric end to end.
std::vector<Pose> rotated_initial_poses(const Pose& from) {
  std::vector<Pose> starts;
  for (int eighth = 1; eighth < 8; ++eighth) {
    starts.push_back(
        {(from.rotation * turn_about_z(eighth * M_PI / 4)).normalized(), from.translation});
  }
  return starts;
}

class Search {
 public:
  Search(const std::vector<SceneFrame>& frames, const FindReferenceSettings& settings)
      : frames_(frames), settings_(settings), coarse_(frames) {
    std::size_t corners = 1, pixels = 1;
    for (const SceneFrame& frame : frames) {
      views_.push_back(frame.view());
      links_.push_back(frame.links());
      corners = std::max({corners, frame.model.corners.size(), frame.cloud.points.size()});
      pixels = std::max(pixels, frame.depth_m.size());
    }
    if (scratch_.prepare(static_cast<int>(views_.size()), static_cast<int>(pixels),
                         static_cast<int>(corners)) != Reason::none) {
      throw InputError("the scene has " + std::to_string(views_.size()) + " frames of " +
                       std::to_string(pixels) + " pixels; expected 1 to " +
                       std::to_string(k_scene_views_max) + " of at most " +
                       std::to_string(k_scene_pixels_max));
    }
  }

  // Skips this many of the widest gates, which attract the robot to near floors and plates.
  [[nodiscard]] Candidate aligned(const Pose& start, int gates_skipped) {
    AlignmentSettings fewer = settings_.alignment;
    std::rotate(fewer.gates.begin(), fewer.gates.begin() + gates_skipped, fewer.gates.end());
    fewer.gate_count -= gates_skipped;
    Candidate c;
    ++starts_;
    c.alignment = align_model(views_, start, fewer, scratch_);
    const Pose& T = c.alignment.T_world_base;
    c.judgement = score_alignment(views_, T, settings_.judge, scratch_);
    const double tolerance_m = 2 * settings_.shared_errors.depth_sigma_m;
    c.surface_score = coarse_.score(T, k_end_gate_m);
    c.surface_score_tolerant = coarse_.score(T, k_end_gate_m + tolerance_m);
    return c;
  }

  [[nodiscard]] CoarseSearch& coarse() { return coarse_; }
  [[nodiscard]] int starts() const { return starts_; }

  // Returns why a single link or image rejects a pose that all together accept; empty if none does.
  [[nodiscard]] std::string part_rejection_reason(const Pose& T_world_base) {
    const LinkScores links = score_links(views_, links_, T_world_base, settings_.judge, scratch_);
    std::string reason = link_rejection_reason(links, settings_);
    for (std::size_t v = 0; v < views_.size() && views_.size() > 1 && reason.empty(); ++v) {
      const AlignmentScore picture =
          score_alignment(std::span(views_).subspan(v, 1), T_world_base, settings_.judge, scratch_);
      reason = image_rejection_reason(frames_[v].name, picture, settings_);
    }
    return reason;
  }

  // Covariance of errors that neighbouring pixels share; with too few patches, keeps that of
  // independent noise.
  void spread_covariance(ModelAlignment& alignment) {
    if (alignment.reason != Reason::none || settings_.alignment.gate_count < 1) return;
    const Result<Matrix6> patches =
        patch_covariance(views_, alignment.T_world_base, gate_m(), scratch_);
    if (patches) alignment.covariance = patches.value;
  }

  // Adds errors that a whole image shares, and the scatter of the poses of single images.
  void add_shared_errors(ModelAlignment& alignment) {
    if (alignment.reason != Reason::none || settings_.alignment.gate_count < 1) return;
    const Result<Matrix6> shared = consider_covariance(views_, alignment.T_world_base, gate_m(),
                                                       settings_.shared_errors, scratch_);
    if (shared) alignment.covariance += shared.value;
    alignment.covariance += scatter_of_pictures(alignment.T_world_base);
  }

 private:
  [[nodiscard]] double gate_m() const {
    return settings_.alignment.gates[static_cast<std::size_t>(settings_.alignment.gate_count - 1)]
        .gate_m;
  }

  // Covariance of the mean of the single images' poses about the joint pose; zero for one image.
  [[nodiscard]] Matrix6 scatter_of_pictures(const Pose& T_world_base) {
    Matrix6 sum = Matrix6::Zero();
    AlignmentSettings last = settings_.alignment;
    last.gates[0] = last.gates[static_cast<std::size_t>(last.gate_count - 1)];
    last.gate_count = 1;
    int count = 0;
    for (std::size_t v = 0; v < views_.size() && views_.size() > 1; ++v) {
      const ModelAlignment one =
          align_model(std::span(views_).subspan(v, 1), T_world_base, last, scratch_);
      if (one.reason != Reason::none) continue;
      const Quaternion turn = one.T_world_base.rotation * T_world_base.rotation.conjugate();
      Vector6 off;
      off << one.T_world_base.translation - T_world_base.translation,
          2 * turn.vec() * (turn.w() < 0 ? -1 : 1);
      sum += off * off.transpose();
      ++count;
    }
    return count > 1 ? Matrix6(sum / (count * (count - 1))) : Matrix6(Matrix6::Zero());
  }

  const std::vector<SceneFrame>& frames_;
  const FindReferenceSettings& settings_;
  CoarseSearch coarse_;
  std::vector<SceneView> views_;
  std::vector<std::span<const std::uint16_t>> links_;
  AlignmentScratch scratch_;
  int starts_ = 0;
};

// Converged poses from the rough pose and about it, best first.
std::vector<Candidate> converged_poses(Search& search, const Pose& initial_guess,
                                       const FindReferenceSettings& settings) {
  std::vector<Candidate> ends{search.aligned(initial_guess, 0)};
  if (!settings.search_alternatives) return ends;
  CoarseSearch& coarse = search.coarse();
  const auto add = [&](const Pose& start, int gates_skipped) {
    const int skipped = std::clamp(settings.alignment.gate_count - 1, 0, gates_skipped);
    const Candidate end = search.aligned(start, skipped);
    const auto same = std::find_if(ends.begin(), ends.end(), [&](const Candidate& other) {
      return coarse.surface_motion_m(end.alignment.T_world_base, other.alignment.T_world_base) <
             settings.distinct_min_m;
    });
    if (same == ends.end()) {
      ends.push_back(end);
    } else if (better(end, *same, settings)) {
      *same = end;
    }
  };
  const auto add_best = [&](const std::vector<Pose>& starts, std::size_t count) {
    const std::vector<CoarsePose> best = coarse.best(starts, count, k_coarse_apart_m);
    for (const CoarsePose& pose : best) {
      if (pose.score >= k_coarse_share * best[0].score) add(pose.T_world_base, 1);
    }
  };
  add(initial_guess, 2);
  add_best(spread_poses(initial_guess, settings.range), k_coarse_poses_aligned);
  const auto in_range = [&](const Candidate& end) {
    return settings.range.contains(initial_guess, end.alignment.T_world_base);
  };
  std::erase_if(ends, [&](const Candidate& end) { return !in_range(end); });
  const auto first = [&](const Candidate& a, const Candidate& b) { return better(a, b, settings); };
  std::stable_sort(ends.begin(), ends.end(), first);
  if (ends.empty()) return ends;
  add_best(rotated_initial_poses(ends[0].alignment.T_world_base), k_rotated_poses_aligned);
  std::stable_sort(ends.begin(), ends.end(), first);
  // A rotated pose outside the range can only be an alternative.
  std::stable_partition(ends.begin(), ends.end(), in_range);
  return ends;
}

// Returns whether there is no mask and no camera is more than 0.1 m from the first.
bool from_one_position(const std::vector<SceneFrame>& frames) {
  constexpr double near_m = 0.1;
  return std::all_of(frames.begin(), frames.end(), [&](const SceneFrame& frame) {
    const Vector3 apart =
        frame.T_camera_world.inverse().translation - frames[0].T_camera_world.inverse().translation;
    return frame.mask.empty() && apart.norm() < near_m;
  });
}

}  // namespace

std::string name_of(ReferenceVerdict verdict) {
  switch (verdict) {
    case ReferenceVerdict::accepted:
      return "accepted";
    case ReferenceVerdict::ambiguous:
      return "ambiguous";
    default:
      return "refused";
  }
}

Pose pose_from_xyz_rpy(const std::vector<double>& xyz_rpy) {
  const SineCosine r = sine_cosine(0.5 * xyz_rpy[3]), p = sine_cosine(0.5 * xyz_rpy[4]),
                   y = sine_cosine(0.5 * xyz_rpy[5]);
  const Quaternion roll(r.cosine, r.sine, 0, 0), pitch(p.cosine, 0, p.sine, 0),
      yaw(y.cosine, 0, 0, y.sine);
  return {(yaw * pitch * roll).normalized(), {xyz_rpy[0], xyz_rpy[1], xyz_rpy[2]}};
}

Reference find_reference(const std::vector<SceneFrame>& frames, const Pose& initial_guess,
                         const FindReferenceSettings& given) {
  FindReferenceSettings settings = given;
  const bool alone = from_one_position(frames);
  if (alone) {
    settings.visible_share_min =
        std::max(given.visible_share_min, given.visible_share_min_one_position);
  }
  Search search(frames, settings);
  const std::vector<Candidate> ends = converged_poses(search, initial_guess, settings);
  Reference reference;
  if (ends.empty()) {
    reference.found = search.aligned(initial_guess, 0);
    reference.reason = "no pose in the searched range explains the scene";
    return reference;
  }
  reference.found = ends[0];
  reference.starts = search.starts();
  for (std::size_t i = 1; i < ends.size(); ++i) {
    if (is_alternative(ends[i], reference.found, settings))
      reference.alternatives.push_back(ends[i]);
  }
  search.spread_covariance(reference.found.alignment);
  reference.reason = rejection_reason(reference.found, settings);
  if (reference.reason.empty()) {
    reference.reason = search.part_rejection_reason(reference.found.alignment.T_world_base);
  }
  search.add_shared_errors(reference.found.alignment);
  if (!reference.reason.empty()) return reference;
  if (!reference.alternatives.empty()) {
    reference.verdict = ReferenceVerdict::ambiguous;
    reference.reason = "another pose explains the scene nearly as well";
    return reference;
  }
  if (alone && !settings.search_alternatives) {
    reference.verdict = ReferenceVerdict::ambiguous;
    reference.reason = "one viewpoint without a mask, and no alternative pose was searched";
    return reference;
  }
  reference.verdict = ReferenceVerdict::accepted;
  return reference;
}

}  // namespace glint
