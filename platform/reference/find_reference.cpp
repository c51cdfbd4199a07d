#include "platform/reference/find_reference.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "kernels/elementary.hpp"
#include "kernels/registration/patch_covariance.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

double angle_between(const Pose& a, const Pose& b) {
  return 2 * arc_cosine(std::min(1.0, std::abs(a.rotation.dot(b.rotation))));
}

Quaternion turn_about_z(double radians) {
  const SineCosine half = sine_cosine(0.5 * radians);
  return {half.cosine, 0, 0, half.sine};
}

class Search {
 public:
  Search(const std::vector<SceneFrame>& frames, const FindReferenceSettings& settings)
      : settings_(settings) {
    std::size_t corners = 1, pixels = 1;
    for (const SceneFrame& frame : frames) {
      views_.push_back(frame.view());
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

  [[nodiscard]] Candidate whole(const Pose& start) { return run(start, settings_.alignment); }

  // Without the widest gates, which draw a robot to floors and boards that are near it.
  [[nodiscard]] Candidate narrow(const Pose& start, int gates_skipped) {
    AlignmentSettings fewer = settings_.alignment;
    std::rotate(fewer.gates.begin(), fewer.gates.begin() + gates_skipped, fewer.gates.end());
    fewer.gate_count -= gates_skipped;
    return run(start, fewer);
  }

  // With an eighth of the points and only the wide gates: enough to see where it leads.
  [[nodiscard]] Candidate rough(const Pose& start) {
    AlignmentSettings few;
    few.gates[0] = {0.15, Matching::plane, 8, 10, false};
    few.gates[1] = {0.08, Matching::plane, 6, 10, false};
    few.gate_count = 2;
    return run(start, few);
  }

  // As sure as it is where neighbouring pixels err alike; of too few patches as it was.
  void make_honest(ModelAlignment& alignment) {
    if (alignment.reason != Reason::none || settings_.alignment.gate_count < 1) return;
    const auto last = static_cast<std::size_t>(settings_.alignment.gate_count - 1);
    const Result<Matrix6> covariance = patch_covariance(
        views_, alignment.T_world_base, settings_.alignment.gates[last].gate_m, scratch_);
    if (covariance) alignment.covariance = covariance.value;
  }

  [[nodiscard]] bool same_end(const Pose& a, const Pose& b) const {
    return (a.translation - b.translation).norm() < settings_.elsewhere_m &&
           angle_between(a, b) < settings_.elsewhere_rad;
  }

 private:
  Candidate run(const Pose& start, const AlignmentSettings& alignment) {
    Candidate c;
    c.alignment = align_model(views_, start, alignment, scratch_);
    c.judgement = judge_alignment(views_, c.alignment.T_world_base, settings_.judge, scratch_);
    return c;
  }

  const FindReferenceSettings& settings_;
  std::vector<SceneView> views_;
  AlignmentScratch scratch_;
};

double worth(const Candidate& c) {
  if (c.alignment.reason != Reason::none) return 0;
  const Judgement& j = c.judgement;
  // A pose that hides behind what is in front is not wrong anywhere: it leaves the mask uncovered.
  const double covered = j.mask_pixels > 0 ? j.mask_share() : 1;
  return (j.inlier_share() - j.seen_through_share()) * covered;
}

// Turned about the base's own z by eighths, and shifted along it and across: a robot's base is
// round, its links are alike from both ends.
std::vector<Pose> other_starts(const Pose& from) {
  std::vector<Pose> starts;
  for (int eighth = 1; eighth < 8; ++eighth) {
    starts.push_back(
        {(from.rotation * turn_about_z(eighth * M_PI / 4)).normalized(), from.translation});
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.25, 0.25}) {
      starts.push_back(
          {from.rotation, from.translation + from.rotation * (side * Vector3::Unit(axis))});
    }
  }
  return starts;
}

double largest_sigma(const Matrix3& covariance) {
  return std::sqrt(
      std::max(0.0, Eigen::SelfAdjointEigenSolver<Matrix3>(covariance).eigenvalues().maxCoeff()));
}

std::string percent(double share) {
  char text[16];
  std::snprintf(text, sizeof text, "%.1f %%", 100 * share);
  return text;
}

// Why this is no pose to work with; empty: it is one.
std::string objection(const Candidate& c, const FindReferenceSettings& settings) {
  const Judgement& j = c.judgement;
  if (c.alignment.reason != Reason::none) return "too little of the robot is seen to fix a pose";
  if (j.visible_share() < settings.visible_share_min) {
    return "only " + percent(j.visible_share()) + " of the robot could be seen; wanted " +
           percent(settings.visible_share_min) +
           (settings.visible_share_min < settings.visible_share_min_alone
                ? ""
                : " from one place without a mask");
  }
  if (j.inlier_share() < settings.inlier_share_min) {
    return "only " + percent(j.inlier_share()) + " of the robot lies at the scene; wanted " +
           percent(settings.inlier_share_min);
  }
  if (j.unhidden_seen_through_share() > settings.seen_through_share_max) {
    return "the scene is seen through " + percent(j.unhidden_seen_through_share()) +
           " of what is not hidden of the robot; at most " +
           percent(settings.seen_through_share_max);
  }
  if (j.outline_share() < settings.outline_share_min) {
    return "the scene goes on beside " + percent(1 - j.outline_share()) +
           " of the robot's outline, as flat things do; at most " +
           percent(1 - settings.outline_share_min);
  }
  if (j.mask_pixels > 0 && j.mask_share() < settings.mask_share_min) {
    return "the robot covers only " + percent(j.mask_share()) + " of the mask; wanted " +
           percent(settings.mask_share_min);
  }
  const double sigma_m = largest_sigma(c.alignment.covariance.topLeftCorner<3, 3>());
  const double sigma_rad = largest_sigma(c.alignment.covariance.bottomRightCorner<3, 3>());
  if (sigma_m > settings.sigma_max_m || sigma_rad > settings.sigma_max_rad) {
    return "what is seen leaves the pose open along one direction";
  }
  return "";
}

// A pose that something speaks against is worth less than any other.
bool better(const Candidate& a, const Candidate& b, const FindReferenceSettings& settings) {
  const bool a_good = objection(a, settings).empty(), b_good = objection(b, settings).empty();
  return a_good == b_good ? worth(a) > worth(b) : a_good;
}

// Without a mask, and no camera more than a hand's width from the first.
bool from_one_place(const std::vector<SceneFrame>& frames) {
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

Pose pose_of_seed(const std::vector<double>& seed) {
  const SineCosine r = sine_cosine(0.5 * seed[3]), p = sine_cosine(0.5 * seed[4]),
                   y = sine_cosine(0.5 * seed[5]);
  const Quaternion roll(r.cosine, r.sine, 0, 0), pitch(p.cosine, 0, p.sine, 0),
      yaw(y.cosine, 0, 0, y.sine);
  return {(yaw * pitch * roll).normalized(), {seed[0], seed[1], seed[2]}};
}

Reference find_reference(const std::vector<SceneFrame>& frames, const Pose& seed,
                         const FindReferenceSettings& given) {
  FindReferenceSettings settings = given;
  if (from_one_place(frames)) {
    settings.visible_share_min = std::max(given.visible_share_min, given.visible_share_min_alone);
    settings.outline_share_min = std::max(given.outline_share_min, given.outline_share_min_alone);
  }
  Search search(frames, settings);
  Reference reference;
  reference.found = search.whole(seed);
  reference.starts = 1;
  for (int skip = 1; settings.other_starts && skip < 3; ++skip) {
    if (settings.alignment.gate_count <= skip) break;
    if (objection(reference.found, settings).empty()) break;
    ++reference.starts;
    const Candidate narrow = search.narrow(seed, skip);
    if (better(narrow, reference.found, settings)) reference.found = narrow;
  }
  if (settings.other_starts) {
    // About where the first ended if that is any good, else about the seed.
    const bool good = objection(reference.found, settings).empty();
    const Pose about = good ? reference.found.alignment.T_world_base : seed;
    std::vector<Pose> ends;
    for (const Pose& start : other_starts(about)) {
      ++reference.starts;
      const Candidate end = search.rough(start);
      const Pose& T = end.alignment.T_world_base;
      const bool known = search.same_end(T, reference.found.alignment.T_world_base) ||
                         std::any_of(ends.begin(), ends.end(),
                                     [&](const Pose& e) { return search.same_end(T, e); });
      // Rough ends lie some centimetres off: half of the first one's worth is worth a closer look.
      if (known || worth(end) < 0.5 * worth(reference.found)) continue;
      ends.push_back(T);
      Candidate rival = search.whole(T);
      if (search.same_end(rival.alignment.T_world_base, reference.found.alignment.T_world_base)) {
        continue;
      }
      if (better(rival, reference.found, settings)) std::swap(rival, reference.found);
      reference.rivals.push_back(rival);
    }
    std::erase_if(reference.rivals, [&](const Candidate& rival) {
      return worth(rival) < settings.rival_share * worth(reference.found) ||
             !objection(rival, settings).empty();
    });
  }
  search.make_honest(reference.found.alignment);
  reference.why = objection(reference.found, settings);
  if (!reference.why.empty()) return reference;
  if (!reference.rivals.empty()) {
    reference.verdict = ReferenceVerdict::ambiguous;
    reference.why = "another pose explains the scene nearly as well";
    return reference;
  }
  reference.verdict = ReferenceVerdict::accepted;
  return reference;
}

}  // namespace glint
