// glint export: marker positions, poses and ground truth of recorded frames, as text.
#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "platform/apps/glint/cell_option.hpp"
#include "platform/apps/glint/commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/apps/glint/progress.hpp"
#include "platform/input_error.hpp"
#include "platform/part_file.hpp"
#include "platform/printable.hpp"
#include "platform/sources/open_source.hpp"
#include "platform/tools/inspect/frame_export.hpp"

namespace glint {
namespace {

struct FrameExportArguments {
  std::string source, tool, out, config, kind, json, frame = "world";
  bool of_tip = false;
};

struct FrameExportKind {
  const char *name, *what, *file, *columns;
  bool has_frame, has_origin;
};

constexpr FrameExportKind k_points{
    "points",
    "All marker positions of each frame, unlabelled, in the camera's frame",
    "out/points.csv",
    "time_s,x_m,y_m,z_m, one marker's centre a row, for `glint replay --points` and `glint\n"
    "calibrate tool|pivot --points`. The whole frame is searched. The centre lies behind the\n"
    "measured surface by the radius of --tool's markers.",
    false,
    false};
constexpr FrameExportKind k_tum{
    "tum",
    "The tracked poses of one tool as TUM text, a row for each frame with a fit",
    "out/poses.tum",
    "t x y z qx qy qz qw: T_world_tool, or T_camera_tool, by the fit of this frame's markers.\n"
    "Frames with fewer than three of the tool's markers have no row.",
    true,
    true};
constexpr FrameExportKind k_csv{
    "csv",
    "One row for each frame and tool: state, reason, pose, standard deviations, markers",
    "out/poses.csv",
    "time_s, sequence, tool, state, reason; then, of a measured tool, frame (world where the "
    "frame\n"
    "has a head pose, else camera), marker_mask, rms_m, x_m to qw, and standard deviations of\n"
    "position and rotation about that frame's axes.",
    false,
    true};
constexpr FrameExportKind k_truth{
    "truth",
    "The true poses of one tool in simulated frames as TUM text, a row for each frame",
    "out/truth.tum",
    "t x y z qx qy qz qw: T_world_tool, or T_camera_tool, at the frame's stamp. SOURCE: a\n"
    "recording of `glint simulate`, or of `glint run` with simulated frames.",
    true,
    true};

// Indices of the tools of the rows: the named one, else all.
std::vector<std::size_t> tools_of(RecordedFrames& recorded, const std::string& name) {
  if (!name.empty()) return {select_tool(recorded.cell, name)};
  std::vector<std::size_t> tools;
  for (int t = 0; t < recorded.cell.tools.count; ++t) tools.push_back(static_cast<std::size_t>(t));
  return tools;
}

ExportedRows export_rows(const FrameExportKind& kind, const FrameExportArguments& arguments,
                         RecordedFrames& recorded, const LineOut& out) {
  PoseExport wanted;
  wanted.frame = arguments.frame == "camera" ? ReferenceFrame::camera : ReferenceFrame::world;
  wanted.origin = arguments.of_tip ? PoseOrigin::tip : PoseOrigin::tool;
  const std::string_view name = kind.name;
  if (name == k_csv.name) {
    return export_csv(recorded, tools_of(recorded, arguments.tool), wanted.origin, out);
  }
  wanted.tool = select_tool(recorded.cell, arguments.tool);
  if (name == k_points.name) return export_points(recorded, wanted.tool, out);
  if (name == k_tum.name) return export_tum(recorded, wanted, out);
  return export_ground_truth(recorded, wanted, out);
}

int run_frame_export(const FrameExportKind& kind, const FrameExportArguments& arguments) {
  const bool truth = std::string_view(kind.name) == k_truth.name;
  if (truth && !arguments.config.empty()) {
    throw InputError(
        "export truth: --config; expected none: the recording's own cell has the "
        "simulator's settings");
  }
  RecordedFrames recorded = open_recorded(arguments.source, arguments.config, arguments.kind);
  LineWriter file(arguments.out);
  Progress progress("exporting");
  int lines = 0;
  const ExportedRows rows = export_rows(kind, arguments, recorded, [&](std::string_view line) {
    file.add(line);
    progress.show(++lines, 0);
  });
  progress.clear();
  file.finish();
  const bool piped = is_special_file(arguments.out);  // the rows may be on standard output
  nlohmann::ordered_json figures{{"source", arguments.source},
                                 {"kind", kind.name},
                                 {"file", arguments.out},
                                 {"frames", rows.frames},
                                 {"rows", rows.rows}};
  if (kind.has_frame) figures["frame"] = arguments.frame;
  if (!kind.has_origin) figures["frame"] = "camera";
  if (kind.has_origin) figures["origin"] = arguments.of_tip ? "tip" : "tool";
  figures["frames_left_out_without_head_pose"] = rows.without_head_pose;
  figures["failures"] = rows.failures;
  if (!piped) {
    std::printf("frames   %d\nrows     %d\n", rows.frames, rows.rows);
    if (figures.contains("frame")) {
      std::printf("frame    %s\n", figures["frame"].get<std::string>().c_str());
    }
    if (rows.without_head_pose > 0) {
      std::printf("notice   %d frames with a pose left out: no head pose\n",
                  rows.without_head_pose);
    }
    std::printf("written  %s\n", printable(arguments.out).c_str());
  }
  write_json(arguments.json, figures);
  return report_losses(rows.failures);
}

void add_kind(CLI::App& parent, const FrameExportKind& kind, int& exit_code) {
  CLI::App* command = parent.add_subcommand(kind.name, kind.what);
  auto arguments = std::make_shared<FrameExportArguments>();
  arguments->out = kind.file;
  command->footer(std::string("Example: glint export ") + kind.name +
                  " out/run.mcap --tool pen --out " +
                  std::filesystem::path(kind.file).filename().string() + "\n" + kind.columns);
  command
      ->add_option("SOURCE", arguments->source,
                   "recorded frames (any kind that `glint track` reads)")
      ->required();
  command->add_option("--tool", arguments->tool,
                      "tool of the cell, built-in tool or tool file; default: the cell's first" +
                          std::string(kind.has_origin && !kind.has_frame ? "; here all" : ""));
  command->add_option("--out", arguments->out, "output file")->capture_default_str();
  if (kind.has_frame) {
    command->add_option("--frame", arguments->frame, "frame of the poses")
        ->check(CLI::IsMember({"world", "camera"}))
        ->capture_default_str();
  }
  if (kind.has_origin) {
    command->add_flag("--of-tip", arguments->of_tip,
                      "origin of the poses at the tool's tip, as in a run's tip.tum");
  }
  command->add_option("--kind", arguments->kind,
                      "kind of SOURCE: " + recorded_kinds() + "; default: detected");
  add_cell_option(*command, arguments->config,
                  "cell file; default: the recording's own, else the built-in cell");
  command->add_option("--json", arguments->json, "file of the counts");
  command->callback(
      [arguments, &kind, &exit_code] { exit_code = run_frame_export(kind, *arguments); });
}

}  // namespace

void add_export(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "export", "Export marker positions, poses and truth of recorded frames as text");
  command->require_subcommand(1);
  command->footer("Example: glint export tum out/run.mcap --tool pen --out pen.tum");
  for (const FrameExportKind* kind : {&k_points, &k_truth, &k_tum, &k_csv}) {
    add_kind(*command, *kind, exit_code);
  }
}

}  // namespace glint
