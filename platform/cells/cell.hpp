// Cell: the configuration of a run, read from one TOML file with units in the names of its keys.
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
#include "kernels/motion/head_drift_correction.hpp"
#include "kernels/motion/motion_filter.hpp"
#include "kernels/pose/bias_correction.hpp"
#include "kernels/pose/tool.hpp"
#include "kernels/units.hpp"
#include "kernels/wire/can_layout.hpp"
#include "platform/cells/dds_input.hpp"
#include "platform/cells/named_file.hpp"
#include "platform/cells/tool_changes.hpp"
#include "platform/formats/camera.hpp"
#include "platform/sinks/record/button_event.hpp"

namespace glint {

struct CanSettings {
  std::string sink = "log:can.log";  // log:FILE or socketcan:IF; FILE is relative to --out
  CanFormat format = CanFormat::classic;
  std::uint32_t base_id = 0x1A0;
  std::int64_t bit_rate = 1'000'000;
  std::int64_t data_bit_rate = 4'000'000;
  int node = 32;                         // heartbeat 0x700 + node
  std::optional<std::uint32_t> buttons;  // identifier of the frame with held buttons; empty: none
};

struct DdsCellSettings {
  bool on = true;
  std::string interface = "lo";
  int domain = 0;
  AllowedInputs allow;   // from other participants
  std::string security;  // folder with keys and documents; empty: no DDS Security
  std::string name;      // namespace of all topics and of the node; empty: none
  RosGraph ros_graph = RosGraph::off;
};

// Server of OpenIGTLink messages.
struct OpenIgtLinkSettings {
  std::string address = "127.0.0.1";  // IPv4, of the interface that it listens on
  int port = 18944;
  Duration period = milliseconds(20);  // between two messages of a tool
};

struct RecordSettings {
  std::string file = "run.mcap";  // relative to --out; empty: no recording
  std::string level = "roi";      // full, roi, blobs, outputs
  bool pictures = false;          // the live view's pictures, regions and scene as well
};

// Trajectories as text; paths relative to --out, empty: none.
struct FileSettings {
  std::string tum = "tip.tum";  // tip of the first tool, for evo and similar
  std::string csv;              // every sample of every tool
};

enum class Method : std::uint8_t {
  glint,
  baseline,  // baseline, Puljiz et al.; first tool only; neither real-time nor deterministic
};

// Source of the frames.
struct SourceSettings {
  std::string kind = "simulator";  // or a kind of platform/sources
  std::string path;                // its file or folder
  std::string position;            // position in the cell file, for messages
  std::string calibration;         // hl2ss_file, hl2ss: a file; empty: no head pose; downloaded
  // dds and rosbag. Empty: selected from the bag's topics; no pose topic.
  std::string reflectivity_topic, depth_topic, camera_info_topic, pose_topic, world_frame;
  std::optional<int> domain;  // dds; empty: that of [dds]
  bool reliable = false;      // dds: requests lost messages again
  std::string host;           // hl2ss: address or name of the headset
  int port = 0;               // hl2ss: of the camera's stream; 0: its default
  int divisor = 1;            // hl2ss: one of that many frames is sent
  int clock_port = 3809;      // hl2ss: remote configuration, for its clock; 0: not asked
};

// Source of simulated frames; the other parameters of the simulator have one declared default.
struct SimulatorSettings {
  // default, still, touches, trajectories, field; calibrations of the field's device: field_board,
  // field_turn, field_pivot, field_rest, field_look
  std::string scenario = "default";
  double duration_s = 60;
  std::uint64_t seed = 1;
  // A cell file: ground truth of the field's device and tools is drawn around it; empty: this cell.
  std::string ground_truth_cell;
  std::string head_trajectory, pen_trajectory;  // files; scenario = "trajectories"
  double pen_scale = 1.0;                       // scales the pen's motion into view
  // Noise of each marker's image per frame, range at 0.5 m; empty: that of the camera model.
  std::optional<double> marker_range_sigma_m, marker_pixel_sigma_px;
  std::string background;  // a frame file; empty: the synthetic room
  std::string background_layout = "adi";
};

// Deadlines, from a group's release to its end, and of a complete chain. Defaults are derived from
// the rates.
struct DeadlineSettings {
  Duration frame;         // maximum and default: the camera's shortest gap
  Duration tick;          // maximum and default: the tick's period
  Duration frame_to_can;  // last byte in memory -> first CAN frame written; default frame + 2 tick
};

// Overrun policy of each group, applied at its deadline; never in a run without a clock.
struct OverrunSettings {
  bool watch = true;
  graph::OverrunPolicy frame = graph::OverrunPolicy::predict;
  graph::OverrunPolicy tick = graph::OverrunPolicy::hold_last;
};

// What releases the ticks beside their period.
enum class TickRelease : std::uint8_t {
  clock,     // nothing
  estimate,  // each frame's estimate with a measured tool; see session/tick_releases.hpp
};

// Problem size: limits of the nodes, and basis of the latency bounds.
struct BudgetSettings {
  int tools = 0;            // at least the number of listed tools
  int blobs = 64;           // default: twice the markers of the listed tools, at least this
  int runs_per_band = 512;  // default: eight per blob, at least this
  int search_steps = 768;
};

// Background group with a lower priority than the frame and tick groups; it works in slices.
struct BackgroundSettings {
  Duration period = milliseconds(10);  // between releases of slices; its deadline
  int steps = k_background_steps_max;  // per slice, plus the steps of its last point
};

// Mapping of the scene, computed in these slices.
struct MappingSettings {
  std::string source;                   // folder of depth images with poses
  Duration period = milliseconds(200);  // between images; replayed forwards and backwards
  int images_per_map = 10;              // number of new images between two maps
  int stride = 1;                       // of the pixels used, in both directions
  double voxel_m = 0.01;
  int voxels_max = 1 << 17;
  // Robot tracked in the same images; empty: none.
  std::string model;           // of `glint reference --export-model`
  std::vector<double> joints;  // joint positions in the model's order: radians, metres
  // Maximum age of joint states used for an image.
  Duration joints_lost_after = milliseconds(1000);
};

inline constexpr Duration k_lost_after = milliseconds(250);

struct Cell {
  std::string file;  // path, for messages
  std::string text;  // as read; every recording contains it
  Camera camera;
  int ray_steps = k_ray_steps_max;       // of the camera's lens, determined once: see set_camera()
  std::string ray_table;                 // path, or empty
  bool lens_uncertainty_stated = false;  // if true, the lens of the source does not change it
  ToolSet tools;                         // all declared tools
  ToolsPresent tools_at_start = k_all_tools;
  std::vector<ToolChange> tool_changes;  // in time order
  std::vector<std::string> tool_files;
  int reference = -1;                  // index of the static tool; -1: none
  std::vector<std::string> warnings;   // warnings for the user, one line each
  std::vector<NamedFile> named_files;  // of `glint calibrate`, as read; a recording contains them
  MotionSettings motion;               // built-in, or by [motion] file
  BiasCorrection correction;           // none, or by [correction] file
  SourceSettings source;
  SimulatorSettings simulator;
  HeadNoise head_noise;  // of the headset's own localisation
  bool realtime = true;  // frames arrive at their time; false: as fast as possible
  double tick_hz = 250;
  TickRelease tick_release = TickRelease::clock;
  Duration lost_after = k_lost_after;
  Duration actuation_delay;
  int workers = 2;
  Duration arrival_jitter = microseconds(400);  // of a frame's transport, added to the camera's
  DeadlineSettings deadlines;
  OverrunSettings overrun;
  BudgetSettings budget;
  std::optional<BackgroundSettings> background;  // empty: the group does not exist
  std::optional<MappingSettings> mapping;        // empty: its slices have no work
  CanSettings can;
  DdsCellSettings dds;
  std::optional<OpenIgtLinkSettings> openigtlink;  // empty: no server
  Duration button_timeout = k_button_timeout;      // release of a held button that is not repeated
  RecordSettings record;
  FileSettings files;
  Method method = Method::glint;    // chosen on the command line
  bool robot_valid = true;          // T_world_robot is valid; false: poses stay in the world
  bool robot_in_reference = false;  // T_world_robot is T_reference_robot
  Pose T_world_robot;
  // Standard deviations of T_world_robot per axis, unless `glint reference` measured the pose.
  double robot_sigma_m = 0.003, robot_sigma_rad = 0.005;
};

// Replaces the camera and determines ray_steps of its lens from some thousand rays.
void set_camera(Cell& cell, const Camera& camera);

// Lens provided by a source: a table of unit rays, or the text of a `glint calibrate camera` file.
struct SourceLens {
  std::string path;         // for messages
  std::vector<float> rays;  // or empty
  std::string file;         // or empty
};

// Rotations about the fixed axes x, y and z in degrees, as [robot] rotation_deg states them.
[[nodiscard]] Vector3 fixed_axes_deg(const Quaternion& rotation);

// Returns whether the cell names a lens, by file or ray table.
[[nodiscard]] bool names_lens(const Cell& cell);
// Sets the lens of the source's frames; a recording of the run contains it. Throws InputError if
// its size differs from the cell's camera.
void set_lens(Cell& cell, SourceLens lens);
// Throws InputError if the camera has no lens.
void require_lens(const Cell& cell);

// Longest gap between two ticks.
[[nodiscard]] inline Duration tick_period_of(const Cell& cell) {
  return {static_cast<std::int64_t>(1e9 / cell.tick_hz)};
}
// Shortest one. A controller rejects a set that comes less than half a period after the last one;
// an eighth of the period remains for the delays on the bus.
[[nodiscard]] inline Duration shortest_tick_gap_of(const Cell& cell) {
  const Duration period = tick_period_of(cell);
  return cell.tick_release == TickRelease::clock ? period : Duration{period.nanoseconds * 5 / 8};
}
[[nodiscard]] inline double highest_tick_hz_of(const Cell& cell) {
  return cell.tick_release == TickRelease::clock ? cell.tick_hz : cell.tick_hz * 8 / 5;
}

// Returns the limits of all nodes of the cell's graphs.
[[nodiscard]] Limits limits_of(const Cell& cell);

// Returns the cell of `glint run` without --config.
[[nodiscard]] Cell default_cell();

// Contents of a recording that replace the files named by a cell.
struct CellFiles {
  ToolSet tools;
  std::shared_ptr<const std::vector<float>> rays;  // null: the cell names no ray table
  std::map<std::string, std::string> named;        // texts of NamedFile, by key
};

// Throws InputError: file:line, found, expected.
[[nodiscard]] Cell load_cell(const std::string& file);
// With `recorded_files` set opens no other file.
[[nodiscard]] Cell cell_from_text(const std::string& text, const std::string& file,
                                  const CellFiles* recorded_files = nullptr);

}  // namespace glint
