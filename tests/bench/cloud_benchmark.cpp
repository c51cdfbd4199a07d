// Benchmark of the cloud's filter chain and the Point Cloud Library on the same points in the same
// run, one thread, with a comparison of the results. Then the same for the alignment of two clouds.
//   bench_cloud [ROUNDS]       GLINT_TEST_DATA: the folder with robot_scans/
#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "alignment_race.hpp"
#include "cloud_agreement.hpp"
#include "cloud_glint.hpp"
#include "kernels/cloud/depth_points.hpp"
#include "platform/formats/npy.hpp"
#include "rounds.hpp"

namespace glint::bench {
namespace {

// PCL's default number of plane hypotheses: more would only make it slower.
constexpr CloudStepSettings k_settings{0.01f, 0.05f, 0.03f, 0.01f, 9};
constexpr std::array<const char*, k_cloud_steps> k_names = {
    "voxel grid, 1 cm", "outliers, 9 in 5 cm", "smoothing, 3 cm, order 2", "largest plane"};
constexpr double k_chain_speedup_min = 6;
constexpr double k_same_voxels_min = 0.9999;
constexpr double k_centroid_distance_max_m = 1e-5;
constexpr double k_smoothed_distance_max_m = 5e-5;

// Points of five depth images of one camera, every fourth pixel, up to two metres.
std::vector<float> scan_points(const std::filesystem::path& folder) {
  CameraModel camera;
  camera.lens = Lens::pinhole;
  camera.fx = 908.3020629882812, camera.fy = 908.292724609375;
  camera.cx = 642.962158203125 + 0.5, camera.cy = 372.7315368652344 + 0.5;
  DepthPointSettings settings;
  settings.stride = 4;
  settings.depth_max_m = 2.0f;
  constexpr int capacity = 1 << 18;
  std::vector<std::byte> memory(PointCloud::bytes(capacity) + Arena::k_alignment);
  Arena arena(memory);
  PointCloud points;
  if (points.prepare(capacity, arena) != Reason::none) std::abort();
  int dropped = 0;
  for (int i = 0; i < 5; ++i) {
    const NpyArray depth =
        read_npy_float32((folder / ("depth_" + std::to_string(i) + ".npy")).string());
    camera.height = static_cast<int>(depth.shape.at(0));
    camera.width = static_cast<int>(depth.shape.at(1));
    const DepthImageView picture{camera.width, camera.height, depth.values};
    add_depth_points(picture, camera, Pose{}, settings, 0, pixels_of(picture, settings.stride),
                     points, dropped);
  }
  std::vector<float> xyz;
  for (int i = 0; i < points.count; ++i) {
    xyz.insert(xyz.end(), {points.x[i], points.y[i], points.z[i]});
  }
  return xyz;
}

// Both are null without PCL.
struct PclLibrary {
  RunCloudSteps steps = nullptr;
  RunAlignment alignment = nullptr;
};
PclLibrary load_pcl() {
  const std::string file =
      (std::filesystem::canonical("/proc/self/exe").parent_path() / GLINT_BENCH_PCL).string();
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return {};
  return {reinterpret_cast<RunCloudSteps>(dlsym(library, "glint_bench_pcl")),
          reinterpret_cast<RunAlignment>(dlsym(library, "glint_bench_pcl_alignment"))};
}

struct Side {
  std::array<std::vector<double>, k_cloud_steps> seconds;
  std::array<std::vector<float>, k_cloud_steps - 1> points;
  std::array<int, k_cloud_steps> counts{};

  template <class Run>
  void once(const Run& run, int count, bool keep_time) {
    CloudStepResult result{};
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i].resize(3 * static_cast<std::size_t>(count));
      result.points[i] = points[i].data();
    }
    run(result);
    for (std::size_t i = 0; i < k_cloud_steps; ++i) {
      if (keep_time) seconds[i].push_back(result.seconds[i]);
      counts[i] = result.counts[i];
      if (i < points.size()) points[i].resize(3 * static_cast<std::size_t>(counts[i]));
    }
  }
  [[nodiscard]] double median_ms(std::size_t step) {
    std::sort(seconds[step].begin(), seconds[step].end());
    return 1e3 * seconds[step][seconds[step].size() / 2];
  }
};

bool print_bar(const char* what, double value, const char* unit, const char* bar, bool met) {
  std::printf("  %-44s %12.6g %-3s bar: %-12s %s\n", what, value, unit, bar,
              met ? "met" : "MISSED");
  return met;
}

bool compare(Side& glint, Side& pcl) {
  double sums[2] = {0, 0};
  std::printf("  %-28s %10s %10s %7s %10s %10s\n", "", "PCL ms", "Glint ms", "ratio", "PCL",
              "Glint");
  for (std::size_t i = 0; i < k_cloud_steps; ++i) {
    const double a = pcl.median_ms(i), b = glint.median_ms(i);
    sums[0] += a;
    sums[1] += b;
    std::printf("  %-28s %10.2f %10.2f %6.1fx %10d %10d\n", k_names[i], a, b, a / b, pcl.counts[i],
                glint.counts[i]);
  }
  std::printf("  %-28s %10.2f %10.2f %6.1fx\n", "chain", sums[0], sums[1], sums[0] / sums[1]);
  const Agreement voxels = agreement_of(glint.points[0], pcl.points[0], k_centroid_distance_max_m);
  const Agreement kept = agreement_of(glint.points[1], pcl.points[1], k_centroid_distance_max_m);
  const Agreement smooth = agreement_of(glint.points[2], pcl.points[2], 1);
  bool met = print_bar("PCL / Glint, the whole chain", sums[0] / sums[1], "x", ">= 6",
                       sums[0] / sums[1] >= k_chain_speedup_min);
  met &= print_bar("same voxels, centroids within 0.01 mm", voxels.share, "", ">= 0.9999",
                   voxels.share >= k_same_voxels_min);
  met &=
      print_bar("same points kept", kept.share, "", ">= 0.9999", kept.share >= k_same_voxels_min);
  met &= print_bar(
      "voxels' and kept points' counts differ by",
      std::abs(pcl.counts[0] - glint.counts[0]) + std::abs(pcl.counts[1] - glint.counts[1]), "",
      "0", pcl.counts[0] == glint.counts[0] && pcl.counts[1] == glint.counts[1]);
  met &= print_bar("smoothed points with a partner", smooth.share, "", ">= 0.9999",
                   smooth.share >= k_same_voxels_min);
  met &= print_bar("their distance, p99", 1e3 * smooth.p99_m, "mm", "<= 0.05",
                   smooth.p99_m <= k_smoothed_distance_max_m);
  return met;
}

int run(int rounds) {
  const char* const data = std::getenv("GLINT_TEST_DATA");
  const std::filesystem::path folder =
      std::filesystem::path(data != nullptr ? data : "") / "robot_scans" / "xarm7_realsense";
  if (!std::filesystem::is_directory(folder)) {
    std::fprintf(stderr,
                 "bench_cloud: %s is not there; expected GLINT_TEST_DATA to name a folder "
                 "with robot_scans\n",
                 folder.c_str());
    return 3;
  }
  const std::vector<float> xyz = scan_points(folder);
  const int count = static_cast<int>(xyz.size() / 3);
  const PclLibrary library = load_pcl();
  CloudChain chain(k_settings, count);
  Side glint, pcl;
  for (int round = 0; round <= rounds; ++round) {  // round 0 is the warm-up
    glint.once([&](CloudStepResult& r) { chain.run(xyz.data(), count, r); }, count, round > 0);
    if (library.steps != nullptr) {
      pcl.once([&](CloudStepResult& r) { library.steps(xyz.data(), count, k_settings, r); }, count,
               round > 0);
    }
  }
  std::printf("%d points, one thread, processor time, median of %d rounds in turn\n  %s\n", count,
              rounds, GLINT_BENCH_FLAGS);
  if (library.steps != nullptr) {
    const bool alike = compare(glint, pcl);
    return benchmark_alignments(chain.smoothed(), library.alignment, rounds) && alike ? 0 : 1;
  }
  for (std::size_t i = 0; i < k_cloud_steps; ++i) {
    std::printf("  %-28s %10.2f ms %10d\n", k_names[i], glint.median_ms(i), glint.counts[i]);
  }
  (void)benchmark_alignments(chain.smoothed(), nullptr, rounds);
  std::printf("libpcl-dev was not there when this was built: no rival\n");
  return 0;
}

}  // namespace
}  // namespace glint::bench

int main(int argc, char** argv) {
  const std::optional<int> rounds = glint::bench::rounds_of(argc, argv, 5, 1);
  if (!rounds) return 2;
  try {
    return glint::bench::run(*rounds);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_cloud: %s\n", error.what());
    return 2;
  }
}
