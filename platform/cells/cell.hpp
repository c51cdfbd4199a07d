// A cell file: everything a user sets, in one TOML file with its units in the names of its keys.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "graph/overrun.hpp"
#include "kernels/geometry.hpp"
#include "kernels/limits.hpp"
#include "kernels/motion/head_anchor.hpp"
#include "kernels/motion/motion_filter.hpp"
#include "kernels/pose/bias_correction.hpp"
#include "kernels/pose/tool.hpp"
#include "kernels/units.hpp"
#include "platform/cells/named_file.hpp"
#include "platform/cells/tool_changes.hpp"
#include "platform/record/button_event.hpp"
#include "platform/sensors/camera.hpp"

namespace glint {

struct CanSettings {
  std::string sink = "log:can.log";  // log:FILE or socketcan:IF; FILE is relative to --out
  bool fd = false;                   // the FD frame instead of the classic ones
  std::uint32_t base_id = 0x1A0;
  std::int64_t bit_rate = 1'000'000;
  std::int64_t data_bit_rate = 4'000'000;
  int node = 32;                         // heartbeat 0x700 + node
  std::optional<std::uint32_t> buttons;  // of the frame that says which are held; nothing: none
};

struct DdsCellSettings {
  bool on = true;
  std::string interface = "lo";
  int domain = 0;
  bool tool_changes = false;  // by other participants: rt/glint/tool_add, tool_remove
};

struct RecordSettings {
  std::string file = "run.mcap";  // relative to --out; empty: no recording
  std::string level = "roi";      // full, roi, blobs, outputs
};

// Trajectories as text; relative to --out, empty: none.
struct FileSettings {
  std::string tum = "tip.tum";  // the first tool's tip, for evo and its kin
  std::string csv;              // every sample of every tool
};

enum class Method : std::uint8_t {
  glint,
  seed,  // the published method, first tool only; outside real time and determinism
};

// Where frames come from.
struct SourceSettings {
  std::string kind = "simulator";  // or a kind of platform/sources
  std::string path;                // its file or folder
  std::string place;               // where the file names it, for messages
  std::string calibration;         // hl2ss_file: its calibration; empty: no head pose
  // dds and rosbag; empty: chosen by what the bag has, and no pose topic.
  std::string reflectivity_topic, depth_topic, camera_info_topic, pose_topic, world_frame;
  std::optional<int> domain;  // dds; nothing: the one of [dds]
  bool reliable = false;      // dds: asks publishers to repeat what is lost
};

// Where simulated frames come from; everything else about the simulator has one declared default.
struct SimulatorSettings {
  // default, still, touches, trajectories, field; and of the field's device field_turn, _pivot,
  // _rest
  std::string scenario = "default";
  double duration_s = 60;
  std::uint64_t seed = 1;
  // A cell file: the field's device and tools differ from what it states; empty: from this cell.
  std::string drawn;
  std::string head_trajectory, pen_trajectory;  // files; scenario = "trajectories"
  double pen_scale = 1.0;                       // pen motion is scaled into view
  // Of each marker's image in each frame, the range's at 0.5 m; nothing: the camera model's.
  std::optional<double> marker_range_sigma_m, marker_pixel_sigma_px;
  std::string background;  // a frame file, or empty for the drawn room
  std::string background_layout = "adi";
};

// From a group's release until it has to be done, and of a whole chain. What the file leaves out
// follows from the rates.
struct DeadlineSettings {
  Duration frame;         // at most the camera's shortest gap, which is the default
  Duration tick;          // at most the tick's period, which is the default
  Duration frame_to_can;  // last byte in memory -> first CAN frame written; frame + 2 tick
};

// What is done about an activation that is not in time; by its deadline, without a clock never.
struct OverrunSettings {
  bool watch = true;
  graph::OverrunPolicy frame = graph::OverrunPolicy::predict;
  graph::OverrunPolicy tick = graph::OverrunPolicy::hold_last;
};

// The problem that the cell takes on: what its nodes stop at and its bounds are computed from.
struct BudgetSettings {
  int tools = 0;            // at least as many as are listed
  int blobs = 64;           // or twice the markers of the listed tools
  int runs_per_band = 512;  // or eight a blob
  int search_steps = 768;
};

// What runs beneath the frame and tick groups, slice by slice.
struct BackgroundSettings {
  Duration period = milliseconds(10);  // from one slice's release to the next; its deadline
  int steps = k_background_steps_max;  // of a slice, beside what its last point takes
};

// A map of the place, made in those slices.
struct MappingSettings {
  std::string source;                   // a folder of depth pictures with poses
  Duration period = milliseconds(200);  // from one to the next; they are shown to and fro
  int pictures_a_map = 10;              // after so many more there is a new map
  int stride = 1;                       // of the pixels taken, along both sides
  double voxel_m = 0.01;
  int voxels_max = 1 << 17;
  // Of the robot that is followed in the same pictures; empty: none is.
  std::string model;           // of `glint reference --export-model`
  std::vector<double> joints;  // their positions, in the model's order: radians, metres
  // Joint states that came longer before a picture than this say nothing of it.
  Duration joints_lost_after = milliseconds(1000);
};

inline constexpr Duration k_lost_after = milliseconds(250);

struct Cell {
  std::string file;  // where it was read, for messages
  std::string text;  // as read: goes into every recording
  Camera camera;
  int ray_steps = k_ray_steps_max;       // of the camera's lens, found once: see set_camera()
  std::string ray_table;                 // path, or empty
  bool lens_uncertainty_stated = false;  // then the source's own lens does not change it
  ToolSet tools;                         // all that may be there
  ToolsPresent tools_at_start = k_all_tools;
  std::vector<ToolChange> tool_changes;  // in the order of their times
  std::vector<std::string> tool_files;
  int reference = -1;                  // the tool that does not move: its number; -1: none
  std::vector<std::string> notices;    // what its user should know, a line each
  std::vector<NamedFile> named_files;  // of `glint calibrate`, as read: a recording carries them
  MotionSettings motion;               // as built in, or by [motion] file
  BiasCorrection correction;           // none, or by [correction] file
  SourceSettings source;
  SimulatorSettings simulator;
  HeadNoise head_noise;  // of the headset's own localisation
  bool realtime = true;  // frames arrive at their time; otherwise as fast as can be
  double tick_hz = 250;
  Duration lost_after = k_lost_after;
  Duration actuation_delay;
  int workers = 2;
  Duration arrival_jitter = microseconds(400);  // of a frame's transport beyond the camera's
  DeadlineSettings deadlines;
  OverrunSettings overrun;
  BudgetSettings budget;
  std::optional<BackgroundSettings> background;  // nothing: there is no such group
  std::optional<MappingSettings> mapping;        // nothing: its slices have nothing to do
  CanSettings can;
  DdsCellSettings dds;
  Duration button_timeout = k_button_timeout;  // of a held button that its sender does not repeat
  RecordSettings record;
  FileSettings files;
  Method method = Method::glint;    // chosen on the command line
  bool robot_given = true;          // T_world_robot holds; otherwise the pose stays in the world
  bool robot_in_reference = false;  // T_world_robot is T_reference_robot
  Pose T_world_robot;
  // Of it, an axis: of a robot whose place was not measured by `glint reference`.
  double robot_sigma_m = 0.003, robot_sigma_rad = 0.005;
};

// Another camera in its place, with the steps that its lens takes: some thousand rays are tried.
void set_camera(Cell& cell, const Camera& camera);

// A lens that a source brings with its frames: a table of unit rays, or the text of a file of
// `glint calibrate camera`.
struct SourceLens {
  std::string path;         // for messages
  std::vector<float> rays;  // or empty
  std::string file;         // or empty
};

// Whether the cell itself names a lens, by file or ray table.
[[nodiscard]] bool names_lens(const Cell& cell);
// The lens of frames from elsewhere; a recording of the run carries it. Throws InputError: another
// size than the cell's camera.
void set_lens(Cell& cell, SourceLens lens);
// Throws InputError where the camera has none.
void require_lens(const Cell& cell);

// What every node of the cell's graphs stops at.
[[nodiscard]] Limits limits_of(const Cell& cell);

// The cell that `glint run` uses when none is named.
[[nodiscard]] Cell default_cell();

// What a recording carries in place of the files that a cell names.
struct CellFiles {
  ToolSet tools;
  std::shared_ptr<const std::vector<float>> rays;  // null: the cell names no ray table
  std::map<std::string, std::string> named;        // texts of NamedFile, by key
};

// Throws InputError: file:line, what was found, what was expected.
[[nodiscard]] Cell load_cell(const std::string& file);
// With `carried` no other file is opened.
[[nodiscard]] Cell cell_from_text(const std::string& text, const std::string& file,
                                  const CellFiles* carried = nullptr);

}  // namespace glint
