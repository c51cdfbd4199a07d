// glint inspect: detections in one frame, and why a tool is or is not tracked, with an image.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "nodes/output.hpp"
#include "nodes/tracker.hpp"
#include "platform/apps/glint/cell_option.hpp"
#include "platform/apps/glint/commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/apps/glint/progress.hpp"
#include "platform/cells/cell.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/formats/frame_files.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/runtime/session/pipeline.hpp"
#include "platform/sources/open_source.hpp"
#include "platform/tools/inspect/diagnosis.hpp"
#include "platform/tools/inspect/explainer.hpp"
#include "platform/tools/inspect/recorded_frames.hpp"
#include "platform/tools/report/detection_image.hpp"

namespace glint {
namespace {

struct InspectArguments {
  std::string frame, layout = "adi", config, json, out = "out", recording, kind;
  double at_s = -1;  // negative: not set
  std::vector<std::string> tools;
  int threshold = 0;
};

// Horizontal field of view of the pinhole for a frame of another camera, without calibration.
constexpr double k_uncalibrated_degrees = 75.0;

Camera camera_for(FrameFileLayout layout, const FrameBuffer& pixels) {
  Camera camera = hololens2_ahat();
  if (layout != FrameFileLayout::adi) return camera;
  camera.name = "uncalibrated pinhole";
  camera.model = CameraModel{};
  camera.model.width = pixels.width;
  camera.model.height = pixels.height;
  camera.model.cx = 0.5 * pixels.width;
  camera.model.cy = 0.5 * pixels.height;
  camera.model.fx = camera.model.fy =
      camera.model.cx / std::tan(0.5 * k_uncalibrated_degrees * 3.14159265358979323846 / 180.0);
  camera.depth.wrap_range_m = 0;
  camera.depth.invalid_from = 0xFFFF;
  camera.range_max_m = 3.0;
  return camera;
}

nlohmann::ordered_json blob_json(const Blob& blob, const Marker* marker) {
  nlohmann::ordered_json item{{"x_px", blob.centroid_px.x()},
                              {"y_px", blob.centroid_px.y()},
                              {"area_px", blob.area_px},
                              {"peak", blob.peak},
                              {"saturated", (blob.flags & k_blob_saturated) != 0},
                              {"touches_edge", (blob.flags & k_blob_touches_edge) != 0},
                              {"has_neighbour", (blob.flags & k_blob_has_neighbour) != 0},
                              {"uneven", (blob.flags & k_blob_partial_or_merged) != 0},
                              {"sigma_x_px", std::sqrt(blob.variance_px2[0])},
                              {"sigma_y_px", std::sqrt(blob.variance_px2[1])}};
  if (marker != nullptr && (marker->flags & k_marker_no_depth) == 0) {
    item["range_m"] = marker->surface_range_m;
    item["range_sigma_m"] = marker->range_sigma_m;
    item["ring_depth"] = (marker->flags & k_marker_annulus_depth) != 0;
    item["wrapped"] = (marker->flags & k_marker_wrapped) != 0;
  }
  return item;
}

const Marker* marker_of(const Markers& markers, int blob) {
  for (int i = 0; i < markers.count; ++i) {
    const Marker& marker = markers.items[static_cast<std::size_t>(i)];
    if (marker.blob == blob) return &marker;
  }
  return nullptr;
}

nlohmann::ordered_json tool_json(const Tool& tool, const Track& track) {
  const Vector3& t = track.T_camera_tool.translation;
  const Quaternion& q = track.T_camera_tool.rotation;
  const Vector3 tip = track.T_camera_tool * tool.tip_m;
  return {{"name", std::string(tool.name.data())},
          {"position_m", {t.x(), t.y(), t.z()}},
          {"rotation_xyzw", {q.x(), q.y(), q.z(), q.w()}},
          {"tip_m", {tip.x(), tip.y(), tip.z()}},
          {"marker_mask", track.marker_mask},
          {"rms_mm", track.rms_m * 1e3}};
}

std::size_t frame_number(const std::string& text) {
  std::size_t number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc{} && rest == text.data() + text.size()) return number;
  throw InputError("--frame " + text + ": expected a frame's number, from 0, with --recording");
}

// The inspected frame and the tracker's result.
struct Inspected {
  Cell cell;
  std::unique_ptr<Tracker> tracker = std::make_unique<Tracker>();
  FrameBuffer pixels;                   // of a frame file
  std::unique_ptr<FrameSource> source;  // of a recording; owns the frame's pixels
  std::string text, picture_name;
  std::optional<CheckRow> at_that_time;   // whether there was a frame
  std::vector<Explanation> explanations;  // of a recording: by tool
};

// The explanations that a run of these frames records.
class ExplainedFrames {
 public:
  explicit ExplainedFrames(const Cell& cell) : explainer_(cell), tools_(cell.tools.count) {
    configure(cell, *output_);
    output_->latest<RobotFrame>().set(declared_robot_frame(cell), 1, 0);
  }

  void add(const ArrivedFrame& arrived, const Estimates& estimates) {
    const Frame& frame = arrived.frame;
    explainer_.add_head(arrived.head);
    if (explainer_.examines(frame.arrival)) {
      (void)explainer_.add_frame(frame);
    } else {
      explainer_.add_arrival(frame.mid_exposure, frame.arrival);
    }
    if (!estimates.verdict.usable())
      explainer_.add_refused(frame.arrival, estimates.verdict.reason);
    output_->latest<Estimates>().set(estimates, ++versions_, 0);
    tick(frame.arrival);
  }

  // By tool, at the tick of this time.
  [[nodiscard]] std::vector<Explanation> at(Time time) {
    tick(time);
    std::vector<Explanation> all;
    for (int t = 0; t < tools_; ++t) {
      all.push_back(explainer_.explanation(static_cast<std::size_t>(t)));
    }
    return all;
  }

 private:
  void tick(Time time) {
    output_->input<Now>() = {time, ++ticks_, 0};
    output_->activate();
    const PoseSamples& samples = output_->output<PoseSamples>();
    for (int t = 0; t < samples.count; ++t) {
      explainer_.add_output(samples.items[static_cast<std::size_t>(t)]);
    }
  }

  Explainer explainer_;
  std::unique_ptr<Output> output_ = std::make_unique<Output>();
  int tools_;
  std::uint64_t versions_ = 0, ticks_ = 0;
};

void start_tracker(Inspected& inspected) {
  configure(inspected.cell, *inspected.tracker);
  inspected.tracker->latest<ToolSet>().set(inspected.cell.tools, 1, 0);
}

void put_overrides(const InspectArguments& arguments, Cell& cell) {
  if (arguments.threshold > 0) {
    cell.camera.threshold = static_cast<std::uint16_t>(arguments.threshold);
  }
  if (!arguments.tools.empty()) cell.tools = ToolSet{};
  for (const std::string& file : arguments.tools) {
    if (cell.tools.count == k_tools_max) {
      throw InputError("--tool " + file + ": expected at most " + std::to_string(k_tools_max));
    }
    cell.tools.items[static_cast<std::size_t>(cell.tools.count++)] = named_tool(file);
  }
}

Inspected inspected_file(const InspectArguments& arguments) {
  const FrameFileLayout layout = frame_file_layout_of(arguments.layout);
  Inspected inspected;
  inspected.cell = cell_or_default(arguments.config);
  inspected.pixels = load_frame(arguments.frame, layout);
  if (arguments.config.empty()) set_camera(inspected.cell, camera_for(layout, inspected.pixels));
  put_overrides(arguments, inspected.cell);
  start_tracker(inspected);
  const Time time = Time{} + milliseconds(1);
  inspected.tracker->input<Frame>() = inspected.pixels.view(time, time, 1);
  inspected.tracker->activate();
  inspected.text = arguments.frame;
  inspected.picture_name = std::filesystem::path(arguments.frame).stem().string();
  return inspected;
}

// Tracks up to the frame, so that it is processed as in a run.
Inspected inspected_recording(const InspectArguments& arguments) {
  const bool by_time = arguments.at_s >= 0;
  const std::size_t wanted = by_time ? SIZE_MAX : frame_number(arguments.frame);
  Inspected inspected;
  inspected.cell = recorded_source_cell(arguments.recording, arguments.config, arguments.kind);
  Cell& cell = inspected.cell;
  put_overrides(arguments, cell);
  inspected.source = open_source(cell);
  start_tracker(inspected);
  Progress progress("tracking");
  inspected.source->start({});
  ExplainedFrames explained(cell);
  ArrivedFrame current, next;
  std::size_t frames = 0;
  double after_s = 0;
  const Time at{static_cast<std::int64_t>(std::llround(std::max(0.0, arguments.at_s) * 1e9))};
  while (frames <= wanted && inspected.source->wait(next)) {
    if (by_time && next.frame.arrival > at) {
      after_s = (next.frame.arrival - Time{}).seconds();
      break;
    }
    if (frames++ > 0) inspected.source->release_pixels(current);
    current = next;
    inspected.tracker->input<Frame>() = current.frame;
    inspected.tracker->input<HeadPose>() = current.head;
    inspected.tracker->activate();
    explained.add(current, inspected.tracker->output<Estimates>());
  }
  progress.clear();
  const auto seconds = [](Time time) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f s", (time - Time{}).seconds());
    return std::string(text);
  };
  if (frames == 0) {
    throw InputError(arguments.recording + ": no frame arrived up to " + seconds(at) +
                     "; expected a time after its first");
  }
  if (!by_time && frames <= wanted) {
    throw InputError(arguments.recording + ": " + std::to_string(frames) +
                     " frames; expected --frame from 0 to " + std::to_string(frames - 1));
  }
  inspected.explanations = explained.at(by_time ? at : current.frame.arrival);
  inspected.text =
      "frame " + std::to_string(frames - 1) + ", arrived at " + seconds(current.frame.arrival);
  inspected.picture_name = "frame_" + std::to_string(frames - 1);
  if (by_time) {
    const double age_ms = (at - current.frame.arrival).seconds() * 1e3;
    const bool fresh = age_ms <= 1.5e3 * cell.camera.period.seconds();
    char text[96];
    std::snprintf(text, sizeof text, "the newest one is %.0f ms old", age_ms);
    inspected.at_that_time = CheckRow{
        "frame at that time", fresh, text,
        fresh ? ""
              : "check the source for gaps; " +
                    (after_s > 0 ? "the next frame arrives at " + std::to_string(after_s) + " s"
                                 : std::string("it is the last frame"))};
  }
  return inspected;
}

nlohmann::ordered_json rows_json(const std::vector<CheckRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const CheckRow& row : rows) {
    list.push_back({{"check", row.check},
                    {"holds", row.passes},
                    {"found", row.found},
                    {"next_step", row.next_step}});
  }
  return list;
}

void print_rows(const ToolDiagnosis& diagnosis) {
  std::printf("%s: %s\n", printable(diagnosis.tool).c_str(),
              diagnosis.cause.empty() ? "tracked" : ("not tracked: " + diagnosis.cause).c_str());
  for (const CheckRow& row : diagnosis.rows) {
    std::printf("  %-3s %-19s %s\n", row.passes ? "ok" : "NO", row.check.c_str(),
                printable(row.found).c_str());
    if (!row.next_step.empty()) std::printf("      next: %s\n", printable(row.next_step).c_str());
  }
}

int inspect(const InspectArguments& arguments) {
  Inspected inspected =
      arguments.recording.empty() ? inspected_file(arguments) : inspected_recording(arguments);
  const Cell& cell = inspected.cell;
  Tracker& tracker = *inspected.tracker;
  const Blobs& blobs = tracker.token<Blobs>();
  const Markers& markers = tracker.token<Markers>();
  const std::vector<std::string> names = marker_names(cell, tracker);
  nlohmann::ordered_json blob_list = nlohmann::ordered_json::array();
  for (int i = 0; i < blobs.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    blob_list.push_back(blob_json(blobs.items[at], marker_of(markers, i)));
    if (!names[at].empty()) blob_list.back()["marker"] = names[at];
  }
  nlohmann::ordered_json found = nlohmann::ordered_json::array();
  nlohmann::ordered_json reasons = nlohmann::ordered_json::array();
  std::vector<std::string> lines{inspected.text};
  std::printf("%s: %d blobs, %u outside the size gate, %u beyond the budget\n",
              printable(inspected.text).c_str(), blobs.count, blobs.dropped - blobs.left_out,
              blobs.left_out);
  const Estimates& estimates = tracker.output<Estimates>();
  std::vector<ToolDiagnosis> all = diagnose(cell, tracker);
  for (std::size_t i = 0; i < all.size(); ++i) {
    ToolDiagnosis& diagnosis = all[i];
    if (inspected.at_that_time) {
      diagnosis.rows.insert(diagnosis.rows.begin(), *inspected.at_that_time);
      if (!inspected.at_that_time->passes) diagnosis.cause = inspected.at_that_time->check;
    }
    const Track& track = estimates.tracks[i];
    if (track.measured_now) found.push_back(tool_json(cell.tools.items[i], track));
    reasons.push_back({{"tool", diagnosis.tool},
                       {"reason", std::string(name_of(track.reason))},
                       {"cause", diagnosis.cause},
                       {"checks", rows_json(diagnosis.rows)}});
    if (!inspected.explanations.empty()) {
      reasons.back()["state"] = inspected.explanations[i].state;
      reasons.back()["explanation"] = inspected.explanations[i].text;
    }
    lines.push_back(diagnosis.tool + ": " +
                    (diagnosis.cause.empty() ? "tracked" : "not tracked: " + diagnosis.cause));
    print_rows(diagnosis);
    if (!inspected.explanations.empty()) {
      std::printf("  %s\n", printable(inspected.explanations[i].text).c_str());
    }
  }

  make_folder(arguments.out);
  const std::string picture =
      (std::filesystem::path(arguments.out) / (inspected.picture_name + ".png")).string();
  write_detection_image(picture, tracker.input<Frame>(), tracker.token<Rois>(), blobs, markers,
                        lines, names);
  std::printf("%-16s %s\n", "picture", picture.c_str());
  write_json(arguments.json,
             {{"frame", inspected.text},
              {"layout", arguments.recording.empty() ? arguments.layout : "recording"},
              {"threshold", cell.camera.threshold},
              {"tools", found},
              {"reasons", reasons},
              {"blobs", blob_list},
              {"blobs_dropped", blobs.dropped},
              {"blobs_left_out", blobs.left_out},
              {"picture", picture}});
  return 0;
}

}  // namespace

void add_inspect(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "inspect", "Show one frame's blobs and markers, and each check of the tracking");
  auto arguments = std::make_shared<InspectArguments>();
  command->footer(
      "Examples:\n"
      "  glint inspect --recording out/run.mcap --at 12.3\n"
      "  glint inspect --recording bag --config my_cell.toml --frame 512\n"
      "  glint inspect --frame frame.bin --layout adi --tool pen --json seen.json\n"
      "A recording is tracked from its start to the frame. --out holds the image.");
  command->add_option("--frame", arguments->frame,
                      "frame file; with --recording: frame number, from 0");
  command->add_option("--recording", arguments->recording,
                      "recorded frames (any kind that `glint track` reads)");
  command->add_option("--at", arguments->at_s, "with --recording: time since its start, s")
      ->check(in_range(0.0, 1e6));
  command->add_option("--kind", arguments->kind,
                      "kind of the recording: " + recorded_kinds() + "; default: detected");
  command->add_option("--layout", arguments->layout,
                      "adi: depth u16, confidence u8, brightness u16 planes; ahat: depth and "
                      "brightness u16 planes; pgm: NAME.pgm beside NAME_ab.pgm");
  command->add_option("--tool", arguments->tools, "tool files, or pen (built in)");
  add_cell_option(*command, arguments->config, "cell file with camera and tools");
  command
      ->add_option("--threshold", arguments->threshold,
                   "least reflectivity of a marker, raw counts")
      ->check(in_range(1, 65534));
  command->add_option("--out", arguments->out, "folder of the image")->capture_default_str();
  command->add_option("--json", arguments->json, "file of the figures");
  command->callback([arguments, &exit_code] {
    const bool recorded = !arguments->recording.empty();
    const bool by_time = arguments->at_s >= 0;
    if (arguments->frame.empty() != (recorded && by_time)) {
      throw InputError(
          "glint inspect: expected --frame FILE, or --recording SOURCE with either --at or "
          "--frame");
    }
    if (!recorded && by_time) {
      throw InputError("glint inspect: --at without --recording; expected both");
    }
    exit_code = inspect(*arguments);
  });
}

}  // namespace glint
