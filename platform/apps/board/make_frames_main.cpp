// glint_board_frames: renders a loop of frames for a companion computer, on the host.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "platform/apps/board/frame_loop.hpp"
#include "platform/apps/board/worst_frames.hpp"
#include "platform/exit_code.hpp"
#include "platform/input_error.hpp"
#include "platform/sim/simulator.hpp"
#include "platform/sources/scenario_of.hpp"

namespace glint {
namespace {

struct Arguments {
  std::string cell_file, file;
  int frames = 48;
  int first = 450;  // ten seconds into the default run: hands and clutter, no event
  int worst_every = 8;
};

LoopFrame entry_of(const sim::SimFrame& frame) {
  LoopFrame entry;
  entry.exposure_to_arrival_ns = (frame.arrival - frame.mid_exposure).nanoseconds;
  entry.head_valid = frame.head.valid ? 1 : 0;
  const Pose& pose = frame.head.T_world_camera;
  for (int i = 0; i < 3; ++i) entry.position_m[i] = pose.translation[i];
  for (int i = 0; i < 4; ++i) entry.rotation_xyzw[i] = pose.rotation.coeffs()[i];
  return entry;
}

// Draws raw reflectivity on either side of the threshold, and depth at the centre of the range.
void draw_worst(WorstFrame kind, const Camera& camera, FrameBuffer& pixels) {
  const auto bright = static_cast<std::uint16_t>(camera.threshold + 1);
  const double middle_m = 0.5 * (camera.range_min_m + camera.range_max_m);
  const auto depth = static_cast<std::uint16_t>(middle_m / camera.depth.unit_m);
  draw(kind, bright, 0, depth, pixels);
}

int make(const Arguments& arguments) {
  const Cell cell = arguments.cell_file.empty() ? default_cell() : load_cell(arguments.cell_file);
  const sim::Simulator simulator(scenario_of(cell));
  const int all = simulator.frame_count();
  if (arguments.first < 0 || arguments.first + arguments.frames > all) {
    throw InputError("--first " + std::to_string(arguments.first) + " --frames " +
                     std::to_string(arguments.frames) + ": the scenario has " +
                     std::to_string(all) + " frames; expected at most so many");
  }
  FrameLoopHeader header;
  header.width = static_cast<std::uint32_t>(cell.camera.model.width);
  header.height = static_cast<std::uint32_t>(cell.camera.model.height);
  header.reflectivity_bits = static_cast<std::uint32_t>(cell.camera.reflectivity_bits);
  header.has_depth = 1;
  header.frames = static_cast<std::uint32_t>(arguments.frames);
  header.period_ns = cell.camera.period.nanoseconds;
  FrameLoopWriter writer(arguments.file, header);
  auto frame = std::make_unique<sim::SimFrame>();
  int worst = 0;
  for (int i = 0; i < arguments.frames; ++i) {
    simulator.render(arguments.first + i, *frame);
    LoopFrame entry = entry_of(*frame);
    if (arguments.worst_every > 0 && i % arguments.worst_every == arguments.worst_every - 1) {
      entry.kind = LoopFrameKind::worst;
      draw_worst(static_cast<WorstFrame>(worst++ % k_worst_frames), cell.camera, frame->pixels);
    }
    writer.add(entry, frame->pixels);
  }
  writer.close();
  std::printf("%s: %d frames, %d of them worst inputs\n", arguments.file.c_str(), arguments.frames,
              worst);
  return 0;
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  glint::Arguments arguments;
  CLI::App app{"Renders a loop of frames for glint_board"};
  app.add_option("file", arguments.file, "loop file to write")->required();
  app.add_option("--config,--cell", arguments.cell_file, "cell file; default: the built-in cell");
  app.add_option("--frames", arguments.frames, "number of frames")->check(CLI::PositiveNumber);
  app.add_option("--first", arguments.first, "first frame's number in the scenario");
  app.add_option("--worst-every", arguments.worst_every,
                 "every Nth frame is a worst input; 0: none");
  app.footer("Example: glint_board_frames loop.frames --frames 48 --worst-every 8");
  return glint::exit_code_of(app, "glint_board_frames", [&] {
    app.parse(argc, argv);
    return glint::make(arguments);
  });
}
