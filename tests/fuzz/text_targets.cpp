// Fuzz targets of text files: TOML, INI, JSON, CSV, YAML, trajectories, CAN logs, joint positions.
#include <array>
#include <string>
#include <string_view>

#include "platform/budget/board_file.hpp"
#include "platform/budget/plan_file.hpp"
#include "platform/budget/report/json_view.hpp"
#include "platform/cells/calibration_files.hpp"
#include "platform/cells/cell.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/cells/tool_formats.hpp"
#include "platform/formats/camera.hpp"
#include "platform/formats/points_csv.hpp"
#include "platform/formats/trajectory.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/recorded_cell.hpp"
#include "platform/sinks/can/candump_line.hpp"
#include "platform/tools/reference/camera_info.hpp"
#include "platform/tools/robot/joint_file.hpp"
#include "schedules/task_model.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace glint::fuzz {
namespace {

constexpr const char* k_signature = "0x1+0x2";
constexpr std::array<std::string_view, 2> k_loops = {"call", "runs"};

void read_cell(Bytes bytes) {
  CellFiles files;  // prevents the cell from opening other files
  files.tools.items[0] = default_pen();
  files.tools.count = 1;
  (void)cell_from_text(text_of(bytes), "cell.toml", &files);
}

void read_tool(Bytes bytes) { (void)tool_from_toml_text(text_of(bytes), "tool.toml"); }

void read_board(Bytes bytes) {
  const BoardExpectation expected{
      "build", {{"Tracker", "0x1"}}, {{"FindBlobs", k_loops}, {"Fit", k_loops}}, {}};
  (void)parse_board(text_of(bytes), "board.toml", expected, BoardUse::analyse);
}

void read_plan(Bytes bytes) {
  TaskModel model;
  model.cores = 2;
  TaskGroup frame, tick;
  frame.name = "frame";
  frame.nodes = {{"A", 0, 1, 100, {}}, {"B", 0, 2, 100, {0}}, {"B", 1, 2, 100, {0}}};
  tick.name = "tick";
  tick.nodes = {{"C", 0, 1, 100, {}}};
  model.groups = {frame, tick};
  (void)plan_from_text(text_of(bytes), "plan.toml", model, k_signature);
}

template <class Read>
void read_one(const Read& read) {
  try {
    (void)read();
  } catch (const InputError&) {
  }
}

void read_calibration(Bytes bytes) {
  const NamedFile file{"camera.file", "calibration.toml", text_of(bytes)};
  const CameraModel camera = hololens2_ahat().model;
  read_one([&] { return depth_bias_of(file); });
  read_one([&] { return motion_of(file); });
  read_one([&] { return correction_of(file); });
  (void)lens_of(file, camera);
}

void read_ini(Bytes bytes) { (void)tool_from_ini_text(text_of(bytes), "tool.ini"); }

// Input is a recording's attachment.
void read_json_tools(Bytes bytes) { (void)tools_from_json(text_of(bytes), "run.mcap"); }

// The reads of a report: each value as a list, a number and a text.
void read_json_report(Bytes bytes) {
  const JsonView file = JsonView::of_file(file_of(bytes));
  for (const char* key : {"a", "frame_to_can_us", "rows"}) {
    read_one([&] { return file.list(key); });
    read_one([&] { return file.number(key); });
    read_one([&] { return file.text_or(key, ""); });
  }
}

void read_points(Bytes bytes) { (void)points_from_text(text_of(bytes), "points.csv"); }

void read_trajectory(Bytes bytes) { (void)trajectory_from_text(text_of(bytes), "pen.tum"); }

// Round trip: a parsed line is written, and parsed again with the same result.
void read_candump(Bytes bytes) {
  const std::string line = text_of(bytes);
  const auto record = parse_candump(line);
  if (!record) return;
  CandumpLine buffer;
  const auto again =
      parse_candump(format_candump(record->frame, record->unix_ns, record->interface, buffer));
  expect(again && again->unix_ns == record->unix_ns && again->interface == record->interface &&
             again->frame.identifier == record->frame.identifier &&
             again->frame.length == record->frame.length && again->frame.data == record->frame.data,
         "a line of candump comes back");
}

void read_joints(Bytes bytes) {
  (void)read_joint_positions(file_of(bytes), {"shoulder", "elbow", "wrist"});
}

void read_camera(Bytes bytes) {
  (void)read_camera_frame(file_of(bytes));
  (void)read_camera_info(file_of(bytes));
}

constexpr Target k_text_targets[] = {
    {"toml_cell", read_cell},
    {"toml_tool", read_tool},
    {"toml_board", read_board},
    {"toml_plan", read_plan},
    {"toml_calibration", read_calibration},
    {"ini_tool", read_ini},
    {"json_tools", read_json_tools},
    {"json_report", read_json_report},
    {"csv_points", read_points},
    {"trajectory", read_trajectory},
    {"candump", read_candump},
    {"joints", read_joints},
    {"yaml_camera", read_camera},
};

}  // namespace

std::span<const Target> text_targets() { return k_text_targets; }

}  // namespace glint::fuzz
