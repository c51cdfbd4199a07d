#include "platform/tools/programming/mapped_planes.hpp"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "platform/input_error.hpp"

namespace glint {
namespace {

MappedPlane plane_of(const nlohmann::json& json, const Pose& T_robot_map) {
  const std::vector<double> normal = json.at("normal").get<std::vector<double>>();
  const Vector3 in_map =
      normal.size() == 3 ? Vector3(normal[0], normal[1], normal[2]) : Vector3(Vector3::Zero());
  const double offset_m = json.at("offset_m").get<double>();
  const double rms_mm = json.at("rms_mm").get<double>();
  if (!(std::abs(in_map.norm() - 1) < 1e-3 && std::isfinite(offset_m) && rms_mm >= 0))
    throw InputError("a number out of range");
  return {T_robot_map * (offset_m * in_map), T_robot_map.rotation * in_map, 1e-3 * rms_mm};
}

}  // namespace

std::vector<MappedPlane> read_mapped_planes(const std::string& file, const Pose& T_robot_map) {
  std::ifstream in(file);
  if (!in) throw InputError(file + ": cannot be opened; expected the figures of glint map --json");
  std::vector<MappedPlane> planes;
  std::string place = file;
  try {
    const nlohmann::json json = nlohmann::json::parse(in);
    for (const nlohmann::json& plane : json.at("planes")) {
      place = file + ": planes[" + std::to_string(planes.size()) + "]";
      planes.push_back(plane_of(plane, T_robot_map));
    }
  } catch (const std::exception&) {
    throw InputError(place +
                     ": no plane as glint map --json writes it; expected normal of length "
                     "1, offset_m and rms_mm");
  }
  return planes;
}

}  // namespace glint
