#include "platform/apps/glint/reference_report.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "kernels/angles.hpp"
#include "platform/printable.hpp"

namespace glint {
namespace {

using Json = nlohmann::ordered_json;

Json matrix_json(const Pose& T) {
  const Matrix3 rotation = T.rotation.toRotationMatrix();
  Json json = Json::array();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) json.push_back(rotation(r, c));
    json.push_back(T.translation(r));
  }
  for (const double last : {0.0, 0.0, 0.0, 1.0}) json.push_back(last);
  return json;
}

Json candidate_json(const Candidate& c) {
  return {{"T_camera_base", matrix_json(c.alignment.T_world_base)},
          {"median_surface_mm", 1e3 * c.judgement.median_m},
          {"inlier_share", c.judgement.inlier_share()},
          {"seen_through_share", c.judgement.seen_through_share()},
          {"visible_share", c.judgement.visible_share()},
          {"outline_share", c.judgement.outline_share()}};
}

void print_pose(const char* what, const Candidate& c) {
  const Vector3& t = c.alignment.T_world_base.translation;
  const Quaternion& q = c.alignment.T_world_base.rotation;
  std::printf("%-9s  [%.4f, %.4f, %.4f] m, quaternion x y z w [%.5f, %.5f, %.5f, %.5f]\n", what,
              t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  std::printf("           median distance %.2f mm, within 20 mm %.1f %%, free space %.1f %%\n",
              1e3 * c.judgement.median_m, 100 * c.judgement.inlier_share(),
              100 * c.judgement.seen_through_share());
}

}  // namespace

void print_reference(const Reference& reference, const ReferenceContext& facts) {
  print_pose("base", reference.found);
  const Matrix6& covariance = reference.found.alignment.covariance;
  std::printf("sigma      %.2f mm, %.3f deg an axis\n",
              1e3 * std::sqrt(covariance.topLeftCorner<3, 3>().trace() / 3),
              k_degrees_per_radian * std::sqrt(covariance.bottomRightCorner<3, 3>().trace() / 3));
  std::printf("searched   %.2f m and %.0f deg about the initial pose, %d alignments\n",
              facts.range.translation_m, k_degrees_per_radian * facts.range.rotation_rad,
              reference.starts);
  for (const Candidate& rival : reference.alternatives) print_pose("rival", rival);
  if (facts.triangles_skipped > 0) {
    std::printf("meshes     %d triangles without area skipped\n", facts.triangles_skipped);
  }
  std::printf("verdict    %s%s%s\n", name_of(reference.verdict).c_str(),
              reference.reason.empty() ? "" : ": ", printable(reference.reason).c_str());
}

nlohmann::ordered_json reference_json(const Reference& reference, const ReferenceContext& facts) {
  const ModelAlignment& alignment = reference.found.alignment;
  Json json = candidate_json(reference.found);
  json["verdict"] = name_of(reference.verdict);
  json["why"] = reference.reason;
  json["residual_mm"] = 1e3 * alignment.residual_m;
  Json covariance = Json::array();
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) covariance.push_back(alignment.covariance(r, c));
  }
  json["covariance"] = covariance;  // translation in metres, rotation in radians, camera axes
  json["pairs"] = alignment.pairs;
  json["frames"] = facts.frames;
  json["starts"] = reference.starts;
  json["search_range"] = {{"shift_m", facts.range.translation_m},
                          {"turn_deg", k_degrees_per_radian * facts.range.rotation_rad}};
  json["robot"] = facts.robot;
  json["triangles_skipped"] = facts.triangles_skipped;
  json["rivals"] = Json::array();
  for (const Candidate& rival : reference.alternatives)
    json["rivals"].push_back(candidate_json(rival));
  return json;
}

}  // namespace glint
