// glint_board_pictures: renders depth images with a robot for a companion computer's background
// group, on the host.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "platform/exit_code.hpp"
#include "platform/formats/npy.hpp"
#include "platform/input_error.hpp"
#include "platform/sim/long_throw.hpp"
#include "platform/sources/scenario_of.hpp"

namespace glint {
namespace {

struct Arguments {
  std::string cell_file, folder;
  RobotFiles robot;
  int images = 13;
  int first = 450;  // as in glint_board_frames
  int every = 9;    // in frames: 200 ms at 45 Hz
};

void write(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream stream(path, std::ios::binary);
  stream << bytes;
  stream.close();
  if (!stream) throw InputError(path.string() + ": cannot be written; expected a writable folder");
}

// Pinhole camera matrix with pixel centres at integers.
std::string camera_text() {
  char text[128];
  std::snprintf(text, sizeof text, "%.17g 0 %.17g\n0 %.17g %.17g\n0 0 1\n", k_long_throw.fx,
                k_long_throw.cx - 0.5, k_long_throw.fy, k_long_throw.cy - 0.5);
  return text;
}

std::string pose_text(const Pose& pose) {
  const Matrix3 r = pose.rotation.toRotationMatrix();
  std::string out;
  for (int i = 0; i < 3; ++i) {
    char text[160];
    std::snprintf(text, sizeof text, "%.17g %.17g %.17g %.17g\n", r(i, 0), r(i, 1), r(i, 2),
                  pose.translation(i));
    out += text;
  }
  return out + "0 0 0 1\n";
}

Cell cell_of(const Arguments& arguments) {
  Cell cell = load_cell(arguments.cell_file);
  if (!cell.mapping) throw InputError(cell.file + ": no [mapping]; expected one with joints");
  return cell;
}

int make(const Arguments& arguments) {
  const Cell cell = cell_of(arguments);
  const sim::Simulator simulator(scenario_of(cell));
  const int last = arguments.first + (arguments.images - 1) * arguments.every;
  if (arguments.first < 0 || last >= simulator.frame_count()) {
    throw InputError("--first " + std::to_string(arguments.first) + " to " + std::to_string(last) +
                     ": the scenario has " + std::to_string(simulator.frame_count()) +
                     " frames; expected at most so many");
  }
  const RobotModel robot = load_robot(arguments.robot);
  MappingCamera camera(simulator,
                       posed_surface(robot, cell.mapping->joints, cell.file + ": mapping.joints"),
                       cell.T_world_robot);
  const std::filesystem::path folder(arguments.folder);
  std::filesystem::create_directories(folder);
  write(folder / "camera-intrinsics.txt", camera_text());
  sim::SimFrame frame;
  for (int p = 0; p < arguments.images; ++p) {
    char name[16];
    std::snprintf(name, sizeof name, "%05d", p);
    const std::size_t width = k_long_throw.width, height = k_long_throw.height;
    const NpyArray depth{{height, width},
                         camera.depth(arguments.first + p * arguments.every, frame)};
    write(folder / (std::string(name) + ".depth.npy"), npy_float32_bytes(depth));
    write(folder / (std::string(name) + ".pose.txt"), pose_text(frame.head.T_world_camera));
  }
  std::printf("%s: %d depth images of %s\n", arguments.folder.c_str(), arguments.images,
              robot.name.c_str());
  return 0;
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  glint::Arguments arguments;
  CLI::App app{"Renders depth images with a robot for glint_board's background group"};
  app.add_option("folder", arguments.folder, "folder of the images")->required();
  app.add_option("--config,--cell", arguments.cell_file,
                 "cell file with a scenario, [robot] and the joints of [mapping]")
      ->required();
  app.add_option("--urdf", arguments.robot.urdf, "URDF file of the robot")->required();
  app.add_option("--package-dir", arguments.robot.package_dirs, "folders of package:// paths");
  app.add_option("--pictures", arguments.images, "number of images")->check(CLI::PositiveNumber);
  app.add_option("--first", arguments.first, "first image's frame in the scenario");
  app.add_option("--every", arguments.every, "frames from one image to the next")
      ->check(CLI::PositiveNumber);
  app.footer("Example: glint_board_pictures pictures --config cell.toml --urdf arm.urdf");
  return glint::exit_code_of(app, "glint_board_pictures", [&] {
    app.parse(argc, argv);
    return glint::make(arguments);
  });
}
