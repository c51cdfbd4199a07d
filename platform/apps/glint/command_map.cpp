// glint map: smoothed point cloud with planes, from depth images and poses.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "platform/apps/glint/commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/apps/glint/progress.hpp"
#include "platform/apps/glint/publishing.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/tools/mapping/cloud_files.hpp"
#include "platform/tools/mapping/depth_png.hpp"
#include "platform/tools/mapping/map_chain.hpp"
#include "platform/tools/mapping/map_image.hpp"
#include "platform/tools/mapping/occupancy.hpp"

namespace glint {
namespace {

struct MapArguments {
  std::string data, out = "out", json, octomap;
  double voxel_mm = 10, depth_max_m = 4;
  int stride = 1;
  bool keep_uneven = false;
  OccupancySettings occupancy;
  PublishOptions publish;
};

nlohmann::ordered_json planes_json(const PlaneSearch& planes) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (int i = 0; i < planes.count(); ++i) {
    const Plane& plane = planes.plane(i);
    list.push_back({{"normal", {plane.normal.x(), plane.normal.y(), plane.normal.z()}},
                    {"offset_m", plane.offset_m},
                    {"rms_mm", 1e3 * plane.rms_m},
                    {"points", plane.points}});
  }
  return list;
}

void print_table(const MapCounts& counts, const PlaneSearch& planes) {
  std::printf("%-22s %12lld\n", "measured points", static_cast<long long>(counts.measured));
  if (counts.left_out > 0) {
    std::printf("%-22s %12lld\n", "on pen and hands", static_cast<long long>(counts.left_out));
  }
  std::printf("%-22s %12d\n", "voxels", counts.voxels);
  std::printf("%-22s %12d\n", "without outliers", counts.kept);
  std::printf("%-22s %12d\n", "smoothed", counts.smoothed);
  std::printf("%-22s %12d\n", "on planes", counts.on_planes);
  for (int i = 0; i < planes.count(); ++i) {
    const Plane& plane = planes.plane(i);
    std::printf("plane %-16d %12d points  %.2f mm rms  normal %+.3f %+.3f %+.3f  at %+.3f m\n",
                i + 1, plane.points, 1e3 * plane.rms_m, plane.normal.x(), plane.normal.y(),
                plane.normal.z(), plane.offset_m);
  }
  for (const std::string& notice : counts.notices)
    std::printf("notice  %s\n", printable(notice).c_str());
}

void print_table(const OccupancyCounts& counts) {
  std::printf("%-22s %12lld\n", "rays", static_cast<long long>(counts.rays));
  const auto notice = [](std::int64_t count, const char* what) {
    if (count > 0) std::printf("notice  %lld %s\n", static_cast<long long>(count), what);
  };
  notice(counts.out_of_range, "points outside the octomap's range, left out");
  notice(counts.rays_left_out + counts.points_left_out,
         "rays and points left out: octomap is full");
}

// Returns free space from the pixels of the mapped frames, and the map's points as surface.
std::unique_ptr<Occupancy> occupancy_of(const MapArguments& arguments,
                                        const DepthSequence& sequence,
                                        const DepthPointSettings& depth, const PointCloud& map) {
  if (arguments.octomap.empty()) return nullptr;
  Progress progress("octomap");
  auto occupancy = std::make_unique<Occupancy>(arguments.occupancy);
  int done = 0;
  for (const DepthFrame& frame : sequence.frames) {
    occupancy->add_view(frame.picture(), sequence.camera, frame.T_world_camera, depth,
                        frame.left_out);
    progress.show(++done, static_cast<int>(sequence.frames.size()));
  }
  occupancy->add_surface(map);
  return occupancy;
}

void publish(const MapArguments& arguments, const HostCloud& map, const Occupancy* occupancy) {
  if (arguments.publish.seconds <= 0) return;
  MapPublisher publisher(arguments.publish.settings);
  const Time now = publishing_time();
  if (const std::size_t left = publisher.publish_cloud(map.points, map.normals, now); left > 0) {
    std::printf("notice  %zu points not published: too many; set a larger --voxel-mm\n", left);
  }
  if (occupancy != nullptr) {
    publisher.publish_octomap(occupancy->message_bytes(), occupancy->resolution_m(), now);
  }
  keep_publishing(publisher, arguments.publish);
}

int make_map(const MapArguments& arguments) {
  MapSettings settings;
  settings.voxels.voxel_m = static_cast<float>(1e-3 * arguments.voxel_mm);
  settings.depth.depth_max_m = static_cast<float>(arguments.depth_max_m);
  settings.depth.stride = arguments.stride;
  const DepthSequence sequence = load_depth_sequence(arguments.data);
  Progress progress("map");
  MapChain chain(settings);
  int done = 0;
  for (const DepthFrame& frame : sequence.frames) {
    chain.add_frame(frame.picture(), sequence.camera, frame.T_world_camera, frame.left_out);
    progress.show(++done, static_cast<int>(sequence.frames.size()));
  }
  progress.clear();
  chain.finish();
  if (chain.map().count == 0) {
    throw InputError(arguments.data + ": no point is left of " +
                     std::to_string(chain.counts().measured) +
                     " measured points; expected surfaces with 9 points within 5 cm of each");
  }
  if (!arguments.keep_uneven) chain.project_onto_planes();
  const std::unique_ptr<Occupancy> occupancy =
      occupancy_of(arguments, sequence, settings.depth, chain.map());
  print_table(chain.counts(), chain.planes());
  if (occupancy != nullptr) print_table(occupancy->counts());
  make_folder(arguments.out);
  const auto in_folder = [&](const char* name) {
    return (std::filesystem::path(arguments.out) / name).string();
  };
  const HostCloud map = host_cloud_of(chain.map());
  for (const char* name : {"map.ply", "map.pcd"}) {
    write_cloud(in_folder(name), map);
    std::printf("written  %s\n", in_folder(name).c_str());
  }
  write_map_image(in_folder("map.png"), chain.map(), chain.support(), sequence.camera,
                  sequence.frames[sequence.frames.size() / 2].T_world_camera);
  std::printf("written  %s\n", in_folder("map.png").c_str());
  if (occupancy != nullptr) {
    write_text(arguments.octomap, occupancy->file_bytes());
    std::printf("written  %s\n", arguments.octomap.c_str());
  }
  const MapCounts& counts = chain.counts();
  write_json(arguments.json, {{"frames", sequence.frames.size()},
                              {"measured", counts.measured},
                              {"left_out", counts.left_out},
                              {"voxels", counts.voxels},
                              {"kept", counts.kept},
                              {"smoothed", counts.smoothed},
                              {"on_planes", counts.on_planes},
                              {"planes", planes_json(chain.planes())},
                              {"notices", counts.notices}});
  publish(arguments, map, occupancy.get());
  return 0;
}

}  // namespace

void add_map(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "map", "Build a smooth point cloud with planes from depth images and poses");
  auto arguments = std::make_shared<MapArguments>();
  command->footer(
      "Examples:\n"
      "  glint map --data pictures --out out --json out/map.json\n"
      "  glint map --data pictures --out out --octomap out/map.bt --resolution 0.02\n"
      "The folder holds camera-intrinsics.txt (9 numbers), and for each image NAME.depth.png\n"
      "(16 bits, mm) or NAME.depth.npy (float32, m), and NAME.pose.txt (T_world_camera, 16\n"
      "numbers). Optional NAME.left_out.txt: pen and hands as lines of x y z  x y z  radius.\n"
      "Files: map.ply, map.pcd (metres, with normals) and map.png.\n"
      "--dds: rt/glint/map_points and, with --octomap, rt/glint/octomap, in frame hmd_world.");
  command->add_option("--data", arguments->data, "folder of the depth images")->required();
  command->add_option("--voxel-mm", arguments->voxel_mm, "side of a voxel")
      ->check(in_range(1.0, 100.0))
      ->capture_default_str();
  command->add_option("--depth-max", arguments->depth_max_m, "largest depth, m")
      ->check(in_range(0.2, 20.0))
      ->capture_default_str();
  command->add_option("--stride", arguments->stride, "every Nth pixel of every Nth row")
      ->check(in_range(1, 64))
      ->capture_default_str();
  command->add_flag("--keep-uneven", arguments->keep_uneven, "do not move points onto planes");
  command->add_option("--octomap", arguments->octomap,
                      "octomap file to write (.bt): occupied, free and unknown space");
  command
      ->add_option("--resolution", arguments->occupancy.resolution_m, "side of an octomap voxel, m")
      ->check(in_range(0.002, 1.0))
      ->capture_default_str();
  add_publish_options(*command, arguments->publish);
  command->add_option("--out", arguments->out, "output folder")->capture_default_str();
  command->add_option("--json", arguments->json, "file of the figures");
  command->callback([arguments, &exit_code] { exit_code = make_map(*arguments); });
}

}  // namespace glint
