// glint path: path drawn with the pen while its button was held, as a table and a robot program in
// a controller's language.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "platform/apps/glint/commands.hpp"
#include "platform/apps/glint/losses_json.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/apps/glint/path_reach.hpp"
#include "platform/apps/glint/publishing.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/programming/press_times.hpp"
#include "platform/tools/programming/program_format.hpp"
#include "platform/tools/programming/recorded_path.hpp"
#include "platform/tools/programming/stroke_edits.hpp"
#include "platform/tools/programming/strokes_json.hpp"
#include "platform/tools/programming/strokes_recording.hpp"

namespace glint {
namespace {

struct PathArguments {
  std::string input, with, planes, button, csv, urscript, program, format, name, json;
  std::vector<std::string> edits;
  RecordedPathOptions options;
  ProgramSettings settings;
  ReachArguments reach;
  PublishOptions publish;
};

double largest_sigma_m(const DrawnPath& path) {
  double most = 0;
  for (const PathElement& element : path) {
    for (const UncertainPose& point : element.points) {
      most = std::max(most, point.covariance.topLeftCorner<3, 3>().trace() / 3);
    }
  }
  return std::sqrt(most);
}

double median_sigma_m(const DrawnPath& path) {
  std::vector<double> variances;
  for (const PathElement& element : path)
    for (const UncertainPose& point : element.points)
      variances.push_back(point.covariance.topLeftCorner<3, 3>().trace() / 3);
  if (variances.empty()) return 0;
  const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
  std::nth_element(variances.begin(), middle, variances.end());
  return std::sqrt(*middle);
}

void print_elements(const DrawnPath& path) {
  int number = 0;
  for (const PathElement& element : path) {
    const UncertainPose& first = element.points.front();
    const Vector3& at = first.pose.translation;
    std::printf("%3d  %-12s  %-8s  %5zu points  at %9.3f s  from %+.4f %+.4f %+.4f m\n", ++number,
                element.name.c_str(), name_of(element.kind), element.points.size(),
                static_cast<double>(first.time.nanoseconds) * 1e-9, at.x(), at.y(), at.z());
  }
}

void print_capture(const RecordedPath& drawn, double spacing_m) {
  const CaptureCounts& counts = drawn.counts;
  std::printf("poses while held %lld, used %lld; largest sigma an axis %.2f mm\n",
              static_cast<long long>(counts.poses), static_cast<long long>(counts.poses_accepted),
              1e3 * largest_sigma_m(drawn.path));
  if (drawn.poses == PathPoses::smoothed) {
    std::printf("smoothed over %lld measured frames; median sigma an axis %.2f mm\n",
                static_cast<long long>(drawn.frames), 1e3 * median_sigma_m(drawn.path));
  } else {
    std::printf("poses as sent at the ticks; median sigma an axis %.2f mm\n",
                1e3 * median_sigma_m(drawn.path));
  }
  if (spacing_m < 2 * largest_sigma_m(drawn.path)) {
    std::printf(
        "notice  points are %.2f mm apart, less than twice their sigma: noise dominates some; set "
        "a wider --spacing, or keep a reference body in view\n",
        1e3 * spacing_m);
  }
  const auto notice = [](std::int64_t count, const char* what) {
    if (count > 0) std::printf("notice  %lld %s\n", static_cast<long long>(count), what);
  };
  if (drawn.losses.any())
    std::printf("notice  the recording lacks %s\n", text_of(drawn.losses).c_str());
  notice(drawn.replay_mismatches, "output records differ from the replay's, which was smoothed");
  notice(counts.not_measured, "poses left out: not measured");
  notice(counts.not_in_robot, "poses left out: not in the robot's frame");
  notice(counts.not_usable, "poses left out: out of order or a jump");
  notice(counts.gaps, "strokes ended by a lost pen; the next pose begins another");
  notice(counts.presses_without_effect,
         "button presses without effect: no pose, or nothing to delete or undo");
  notice(counts.points_over_capacity, "points left out: more than --points-max");
  notice(counts.strokes_over_capacity, "elements left out: more than the capacity");
}

nlohmann::ordered_json figures(const RecordedPath& drawn) {
  nlohmann::ordered_json elements = nlohmann::ordered_json::array();
  for (const PathElement& element : drawn.path) {
    elements.push_back({{"name", element.name},
                        {"kind", name_of(element.kind)},
                        {"points", element.points.size()}});
  }
  const CaptureCounts& counts = drawn.counts;
  return {{"tool", drawn.tool},
          {"events", drawn.events},
          {"elements", elements},
          {"points", point_count(drawn.path)},
          {"smoothed", drawn.poses == PathPoses::smoothed},
          {"frames", drawn.frames},
          {"replay_mismatches", drawn.replay_mismatches},
          {"median_sigma_mm", 1e3 * median_sigma_m(drawn.path)},
          {"largest_sigma_mm", 1e3 * largest_sigma_m(drawn.path)},
          {"poses", counts.poses},
          {"taken", counts.poses_accepted},
          {"not_measured", counts.not_measured},
          {"not_in_robot", counts.not_in_robot},
          {"not_usable", counts.not_usable},
          {"gaps", counts.gaps},
          {"presses_in_vain", counts.presses_without_effect},
          {"points_left_out", counts.points_over_capacity},
          {"strokes_left_out", counts.strokes_over_capacity},
          {"missing", losses_json(drawn.losses)}};
}

void publish(const RecordedPath& drawn, const PublishOptions& options) {
  if (options.seconds <= 0) return;
  std::vector<UncertainPose> points;
  for (const PathElement& element : drawn.path) {
    points.insert(points.end(), element.points.begin(), element.points.end());
  }
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
  if (!arguments.program.empty()) {
    files.push_back({arguments.program, program_format(arguments.format, arguments.program)});
  }
  return files;
}

int make_path(PathArguments& arguments) {
  if (!arguments.button.empty()) arguments.options.presses = press_times(arguments.button);
  const std::vector<PathFile> files = requested_files(arguments);
  const RecordedPath drawn = input_path(arguments);
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
  nlohmann::ordered_json json = figures(drawn);
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
      "A held button draws a stroke, a click sets a waypoint. Without --robot no point is checked "
      "for "
      "reachability.\n"
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
      ->add_option("--user-frame", settings.user_frame,
                   "the controller's number of the robot's frame (KRL, RAPID, LS); 0: its base")
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
