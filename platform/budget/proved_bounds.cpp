#include "platform/budget/proved_bounds.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/read_file.hpp"

namespace glint {
namespace {

constexpr std::array k_limit_fields = {
    std::pair{"width", &Limits::width},
    std::pair{"height", &Limits::height},
    std::pair{"tools", &Limits::tools},
    std::pair{"markers_per_tool", &Limits::markers_per_tool},
    std::pair{"blobs", &Limits::blobs},
    std::pair{"runs_per_band", &Limits::runs_per_band},
    std::pair{"lens_steps", &Limits::lens_steps},
    std::pair{"ray_steps", &Limits::ray_steps},
    std::pair{"search_steps", &Limits::search_steps},
    std::pair{"background_steps", &Limits::background_steps},
    std::pair{"tracking_steps", &Limits::tracking_steps},
    std::pair{"reflectivity_bytes", &Limits::reflectivity_bytes},
    std::pair{"centroid_pixels_per_blob", &Limits::centroid_pixels_per_blob},
    std::pair{"range_pixels_per_blob", &Limits::range_pixels_per_blob},
    std::pair{"range_samples_per_blob", &Limits::range_samples_per_blob},
    std::pair{"covariance_frames", &Limits::covariance_frames}};

}  // namespace

nlohmann::ordered_json limits_json(const Limits& limits) {
  nlohmann::ordered_json json;
  for (const auto& [name, field] : k_limit_fields) json[name] = limits.*field;
  return json;
}

bool covers(const Limits& larger, const Limits& smaller) {
  return std::all_of(k_limit_fields.begin(), k_limit_fields.end(), [&](const auto& named) {
    return smaller.*named.second <= larger.*named.second;
  });
}

ProofFile load_proofs(const std::string& file) {
  ProofFile proofs;
  try {
    const auto json = nlohmann::json::parse(read_file(file, k_text_bytes_max, "a proof file"));
    proofs.machine = json.at("machine").get<std::string>();
    for (const auto& [name, field] : k_limit_fields) {
      proofs.limits.*field = json.at("limits").at(name).get<int>();
    }
    for (const auto& kernel : json.at("kernels")) {
      if (kernel.at("kind") != "proved") continue;
      proofs.kernels.push_back({kernel.at("kernel").get<std::string>(),
                                kernel.at("root").get<std::string>(),
                                kernel.at("code_sha256").get<std::string>(),
                                kernel.at("instructions_bound").get<std::int64_t>()});
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file + ": expected a file of `glint budget prove --json`: " + error.what());
  }
  return proofs;
}

}  // namespace glint
