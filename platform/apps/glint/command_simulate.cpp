// glint simulate: simulated frames with ground truth, without tracking.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "platform/apps/glint/cell_option.hpp"
#include "platform/apps/glint/commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/apps/glint/progress.hpp"
#include "platform/cells/cell.hpp"
#include "platform/formats/frame_files.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/runtime/session/recorded_cell.hpp"
#include "platform/sim/simulator.hpp"
#include "platform/sinks/record/recording_writer.hpp"
#include "platform/sinks/record/trajectory_files.hpp"
#include "platform/sources/scenario_of.hpp"

namespace glint {
namespace {

struct SimulateArguments {
  std::string config, out = "out", json;
  double duration_s = 0;
  bool without_pixels = false;
  int file_every = 0;  // every n-th frame is written as a file; 0: none
};

// Poses of one body as TUM text.
class PoseFile {
 public:
  explicit PoseFile(const std::string& path) : path_(path), file_(path) {}
  void add(Time time, const Pose& pose) {
    PoseSample sample;
    sample.tick = sample.measurement = time;
    sample.state = TrackState::measured;
    sample.pose = pose;
    file_.write(sample);
  }
  // Returns the path. Throws InputError if the file could not be written completely.
  std::string close() {
    if (!file_.close()) throw InputError(file_.file().error());
    return path_;
  }

 private:
  std::string path_;
  TumFile file_;
};

int simulate(const SimulateArguments& arguments) {
  Cell cell = cell_or_default(arguments.config);
  if (arguments.duration_s > 0) cell.simulator.duration_s = arguments.duration_s;
  require_lens(cell);
  const sim::Simulator simulator(scenario_of(cell));
  make_folder(arguments.out);
  const auto in_folder = [&](const char* name) {
    return (std::filesystem::path(arguments.out) / name).string();
  };

  std::unique_ptr<RecordingWriter> recording;
  if (!arguments.without_pixels) {
    RecordingInfo info;
    info.level = RecordingLevel::full;
    info.nominal_tick = tick_period_of(cell);
    info.attachments = attachments_of(cell);
    recording = std::make_unique<RecordingWriter>(in_folder("frames.mcap"), info);
  }
  Progress progress("simulating");
  PoseFile head_truth(in_folder("truth_head.tum")), head(in_folder("localised_head.tum"));
  PoseFile pen_truth(in_folder("truth_tool.tum")), pen_reference(in_folder("reference_tool.tum"));
  sim::SimFrame frame;
  std::vector<std::uint8_t> pixels;
  std::vector<std::string> files;
  for (int i = 0; i < simulator.frame_count(); ++i) {
    if (recording == nullptr) {
      simulator.describe(i, frame);
    } else {
      simulator.render(i, frame);
      const FrameLayout layout = whole_frame_layout(frame.view());
      pixels.resize(pixel_bytes(layout));
      copy_pixels(frame.view(), layout, pixels);
      recording->write_head_pose(frame.head);
      recording->write_frame({layout, pixels});
    }
    if (arguments.file_every > 0 && i % arguments.file_every == 0) {
      char name[32];
      std::snprintf(name, sizeof name, "frame_%05d.bin", i);
      write_text(in_folder(name), ahat_bytes(frame.view(), "--frame-files"));
      files.push_back(in_folder(name));
    }
    head_truth.add(frame.truth.mid_exposure, frame.truth.T_world_camera);
    if (frame.head.valid) head.add(frame.head.time, frame.head.T_world_camera);
    if (!frame.truth.T_world_tool.empty()) {
      pen_truth.add(frame.truth.mid_exposure, frame.truth.T_world_tool[0]);
      pen_reference.add(frame.truth.mid_exposure, frame.reference[0]);
    }
    progress.show(i, simulator.frame_count());
  }
  progress.clear();
  for (PoseFile* file : {&head_truth, &head, &pen_truth, &pen_reference}) {
    files.push_back(file->close());
  }
  if (recording != nullptr) {
    const RecordingOutcome outcome = recording->close();
    if (outcome.ended_early) {
      std::fprintf(stderr, "glint: %s\n", printable(outcome.reason).c_str());
      return 1;
    }
    files.push_back(in_folder("frames.mcap"));
  }
  std::printf("%d frames, %.1f s\n", simulator.frame_count(), cell.simulator.duration_s);
  for (const std::string& file : files) std::printf("written  %s\n", file.c_str());
  write_json(arguments.json, {{"frames", simulator.frame_count()}, {"files", files}});
  return 0;
}

}  // namespace

void add_simulate(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("simulate", "Simulate frames with ground truth, without tracking");
  auto arguments = std::make_shared<SimulateArguments>();
  command->footer(
      "Example: glint simulate --duration 5 --out sim\n"
      "Files: frames.mcap; as TUM text the true poses of head and first tool, the headset's\n"
      "localisation, and the reference tracker's poses.");
  add_cell_option(*command, arguments->config);
  command->add_option("--duration", arguments->duration_s, "seconds; default: the cell's")
      ->check(in_range(0.1, 3600.0));
  command->add_flag("--no-frames", arguments->without_pixels, "trajectories only");
  command
      ->add_option("--frame-files", arguments->file_every,
                   "every Nth frame also as a file for `glint inspect --layout ahat`")
      ->check(CLI::PositiveNumber);
  command->add_option("--out", arguments->out, "output folder")->capture_default_str();
  command->add_option("--json", arguments->json, "file of the list of files");
  command->callback([arguments, &exit_code] { exit_code = simulate(*arguments); });
}

}  // namespace glint
