// glint path: path drawn with the pen while its button was held, as a table and a robot program in
// a controller's language.
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "platform/apps/glint/commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/apps/glint/path_reach.hpp"
#include "platform/apps/glint/path_report.hpp"
#include "platform/apps/glint/publishing.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/programming/press_times.hpp"
#include "platform/tools/programming/program_format.hpp"
#include "platform/tools/programming/recorded_path.hpp"
#include "platform/tools/programming/stroke_edits.hpp"
#include "platform/tools/programming/strokes_json.hpp"
#include "platform/tools/programming/strokes_recording.hpp"
#include "platform/tools/programming/user_frame.hpp"

namespace glint {
namespace {

struct PathArguments {
  std::string input, with, planes, button, csv, urscript, program, format, name, json;
  std::vector<std::string> edits, frame;
  RecordedPathOptions options;
  ProgramSettings settings;
  ReachArguments reach;
  PublishOptions publish;
};

void publish(const RecordedPath& drawn, const PublishOptions& options) {
  if (options.seconds <= 0) return;
  std::vector<UncertainPose> points;
  for (const PathElement& element : drawn.path)
    points.insert(points.end(), element.points.begin(), element.points.end());
  MapPublisher publisher(options.settings);
  publisher.publish_path(points, drawn.unix_offset, publishing_time());
  keep_publishing(publisher, options);
}

bool is_strokes_file(const std::string& name) {
  return std::filesystem::path(name).extension() == ".json";
}

// The path as drawn or read, after the edits.
RecordedPath input_path(const PathArguments& arguments) {
  RecordedPath drawn;
  if (is_strokes_file(arguments.input)) {
    StrokesFile strokes = read_strokes(arguments.input);
    drawn.path = std::move(strokes.path);
    drawn.tool = strokes.tool;
    drawn.unix_offset = strokes.unix_offset;
  } else {
    drawn = recorded_path(arguments.input, arguments.options);
  }
  if (!arguments.with.empty()) {
    const DrawnPath first = read_strokes(arguments.with).path;
    drawn.path.insert(drawn.path.begin(), first.begin(), first.end());
  }
  std::vector<MappedPlane> planes;
  if (!arguments.planes.empty())
    planes = read_mapped_planes(arguments.planes, map_pose(arguments.reach).inverse());
  drawn.path = edited(named(std::move(drawn.path)), arguments.edits, planes);
  if (drawn.path.empty())
    throw InputError(arguments.input + ": no element left; expected one or more");
  return drawn;
}

struct PathFile {
  std::string name;
  ProgramFormat format;
};

std::vector<PathFile> requested_files(const PathArguments& arguments) {
  std::vector<PathFile> files;
  if (!arguments.csv.empty()) files.push_back({arguments.csv, ProgramFormat::csv});
  if (!arguments.urscript.empty()) files.push_back({arguments.urscript, ProgramFormat::urscript});
  if (!arguments.program.empty())
    files.push_back({arguments.program, program_format(arguments.format, arguments.program)});
  return files;
}

int make_path(PathArguments& arguments) {
  if (!arguments.button.empty()) arguments.options.presses = press_times(arguments.button);
  const std::vector<PathFile> files = requested_files(arguments);
  RecordedPath drawn = input_path(arguments);
  if (!arguments.frame.empty()) {
    arguments.settings.T_robot_user = user_frame(drawn.path, arguments.frame);
    drawn.path = without(std::move(drawn.path), arguments.frame);
  }
  arguments.settings.recording =
      std::filesystem::path(arguments.input).filename().string() + ", tool " + drawn.tool;
  const PathReachReport reach = check_path(drawn.path, arguments.settings.shapes, arguments.reach);
  arguments.settings.checks = reach.header;
  const StrokesFile strokes{drawn.path, drawn.tool, drawn.unix_offset};
  // Makes all texts before the first file: a rejected path leaves no file.
  std::vector<std::string> texts;
  for (const PathFile& file : files) {
    ProgramSettings settings = arguments.settings;
    settings.name = arguments.name.empty() ? program_name(file.name) : arguments.name;
    texts.push_back(file.format == ProgramFormat::mcap ? std::string()
                                                       : path_text(strokes, settings, file.format));
  }
  print_elements(drawn.path);
  if (!is_strokes_file(arguments.input))
    print_capture(drawn, arguments.options.capture.stroke.spacing_m);
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (files[i].format == ProgramFormat::mcap) {
      make_folder_of(files[i].name);
      write_strokes_recording(files[i].name, strokes);
    } else {
      write_text(files[i].name, texts[i]);
    }
    std::printf("written  %s\n", files[i].name.c_str());
  }
  nlohmann::ordered_json json = path_figures(drawn);
  if (!arguments.reach.robot.empty()) {
    json["reach_failures"] = reach.failures;
    json["moves_not_followed"] = reach.moves_not_followed;
  }
  write_json(arguments.json, json);
  publish(drawn, arguments.publish);
  return drawn.losses.any() || !reach.failures.empty() ? 1 : 0;
}

// Adds an option for a length in metres, given with its unit: 2mm, 0.5cm, 0.01m.
void add_length(CLI::App* command, const std::string& name, double& metres, const std::string& what,
                double least, double most) {
  const std::map<std::string, double> units{{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1}};
  command->add_option(name, metres, what + ", with its unit: mm, cm or m")
      ->transform(CLI::AsNumberWithUnit(units, CLI::AsNumberWithUnit::UNIT_REQUIRED, "LENGTH"))
      ->check(in_range(least, most))
      ->default_str(std::to_string(static_cast<int>(1e3 * metres + 0.5)) + "mm");
}

}  // namespace

void add_path(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "path", "Convert drawn waypoints and strokes to a table and a robot program");
  auto arguments = std::make_shared<PathArguments>();
  command->footer(
      "Examples:\n"
      "  glint path out/run.mcap --csv path.csv --urscript path.script\n"
      "  glint path out/run.mcap --program weld.src --user-frame 2 --tool-frame 1\n"
      "  glint path out/run.mcap --button 1.0..2.5,3.0..4.2 --spacing 2mm --csv path.csv\n"
      "  glint path out/run.mcap --program weld.src --robot arm.urdf --tip pen_tip\n"
      "  glint path out/run.mcap --program weld.src --robot arm.urdf --tip pen_tip --octomap "
      "cell.bt\n"
      "  glint path out/run.mcap --edit \"rename stroke_1 seam\" --edit \"offset seam tool 2mm\" "
      "--program seam.json\n"
      "  glint path out/again.mcap --with seam.json --edit \"replace seam stroke_2\" --program "
      "seam.json\n"
      "  glint path seam.json --planes map.json --edit \"project seam 1\" --edit \"approach seam "
      "tool 50mm\" --program seam.src\n"
      "  glint path seam.json --with corners.json --frame o,x,xy --program seam.src\n"
      "A held button draws a stroke, a click sets a waypoint. Without --robot no point is checked "
      "for reachability.\n"
      "Poses are smoothed in hindsight over the measured frames of a stroke; --live: as sent.\n"
      "--dds: nav_msgs/Path on rt/glint/path, in the robot's frame.");
  command
      ->add_option("input", arguments->input, "recording of `glint run`, or strokes file (.json)")
      ->required();
  command->add_option("--with", arguments->with,
                      "strokes file whose elements precede those of the input");
  command
      ->add_option("--edit", arguments->edits,
                   "edit of the path, applied in the given order: \"delete NAME\", \"rename NAME "
                   "NEW\", \"replace NAME NEWER\", \"offset NAME DIRECTION LENGTH\" (x,y,z, tool "
                   "or normal), \"mirror NAME POINT NORMAL\" (x,y,z), \"project NAME NUMBER\" (of "
                   "a plane), \"approach NAME DIRECTION LENGTH\"; NAME * is every element")
      ->allow_extra_args(false);
  command->add_option("--tool", arguments->options.tool,
                      "name of the pen; default: the first tool");
  command->add_option("--button", arguments->button,
                      "intervals with the button held, FROM..TO in seconds, separated by commas; "
                      "default: the recorded ones");
  command->add_option("--planes", arguments->planes,
                      "figures of `glint map --json`: planes of the edit \"project\"");
  CaptureSettings& capture = arguments->options.capture;
  add_length(command, "--spacing", capture.stroke.spacing_m, "distance between points of a stroke",
             1e-4, 0.1);
  command->add_flag_callback(
      "--live", [arguments] { arguments->options.poses = PathPoses::as_sent; },
      "keep the poses sent at the ticks; default: smoothed over the measured frames, if recorded");
  command->add_option("--points-max", capture.points_max, "capacity in points")
      ->check(in_range(1, 1 << 22))
      ->capture_default_str();
  command->add_option("--csv", arguments->csv, "CSV file of the points and their covariances");
  command->add_option("--urscript", arguments->urscript, "file of the program in URScript");
  CLI::Option* program = command->add_option(
      "--program", arguments->program,
      "file of the program; its suffix selects the language: .script (URScript), .src (KUKA KRL), "
      ".mod (ABB RAPID), .ls (FANUC); .csv: the table; .json, .mcap: the strokes file");
  command->add_option("--format", arguments->format, "language of --program")
      ->check(CLI::IsMember({"urscript", "krl", "rapid", "ls", "csv", "json", "mcap"}))
      ->needs(program);
  command->add_option("--name", arguments->name, "name of the program; default: the file's name");
  ProgramSettings& settings = arguments->settings;
  command
      ->add_option(
          "--frame", arguments->frame,
          "names of three waypoints of the path: origin, on +x, in the x-y plane; programs "
          "are written in this frame, without these waypoints")
      ->delimiter(',')
      ->expected(3);
  command
      ->add_option("--user-frame", settings.user_frame,
                   "the controller's number of the robot's frame (KRL, RAPID, LS); 0: its base; "
                   "with --frame: of the drawn frame (LS)")
      ->check(in_range(0, 99))
      ->capture_default_str();
  command
      ->add_option("--tool-frame", settings.tool_frame,
                   "the controller's number of the tip's frame (KRL, RAPID, LS)")
      ->check(in_range(0, 99))
      ->capture_default_str();
  command->add_option("--stroke-speed", settings.stroke_m_s, "speed along strokes, m/s")
      ->check(in_range(1e-3, 2.0))
      ->capture_default_str();
  command->add_option("--travel-speed", settings.travel_m_s, "speed to waypoints and strokes, m/s")
      ->check(in_range(1e-3, 2.0))
      ->capture_default_str();
  command->add_option("--acceleration", settings.acceleration_m_s2, "m/s^2")
      ->check(in_range(1e-2, 10.0))
      ->capture_default_str();
  command->add_flag_callback(
      "--fit-shapes", [arguments] { arguments->settings.shapes.emplace(); },
      "programs: one move for each line and arc of a stroke that agrees with its covariance");
  add_length(command, "--blend", settings.blend_m, "largest blend radius", 0, 0.1);
  add_reach_options(*command, arguments->reach);
  add_publish_options(*command, arguments->publish);
  command->add_flag("--allow-truncated", arguments->options.tolerance.truncated,
                    "read the undamaged records of a truncated or damaged file, count the missing "
                    "ones; exit code 1");
  command->add_flag("--allow-incomplete", arguments->options.tolerance.incomplete,
                    "read a recording with dropped messages or an early end");
  command->add_option("--json", arguments->json, "file of the figures");
  command->callback([arguments, &exit_code] { exit_code = make_path(*arguments); });
}

}  // namespace glint
