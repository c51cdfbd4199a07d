// Hash of a recording's replay, or of the simulator's frames; `equal_bits` builds it with every
// compiler and optimisation level.
//   glint_equal_bits replay FILE WORKERS
//   glint_equal_bits frames
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>

#include "platform/runtime/session/replay.hpp"
#include "platform/sim/simulator.hpp"
#include "platform/sinks/record/sha256.hpp"
#include "platform/sources/scenario_of.hpp"

namespace glint {
namespace {

int replayed(const char* file, int workers) {
  ReplayOptions options;
  options.workers = workers;
  const ReplayResult result = replay(file, options);
  std::printf("%s\n", result.output_sha256.c_str());
  return result.agrees() ? 0 : 1;
}

template <class Pixel>
void add(Sha256& hash, const std::vector<Pixel>& pixels) {
  hash.add({reinterpret_cast<const std::uint8_t*>(pixels.data()), pixels.size() * sizeof(Pixel)});
}

// Every 50th frame of the default run: markers, hands, clutter, motion, occlusion.
int frames() {
  const sim::Simulator simulator(scenario_of(default_cell()));
  auto frame = std::make_unique<sim::SimFrame>();
  Sha256 hash;
  for (int i = 0; i < simulator.frame_count(); i += 50) {
    simulator.render(i, *frame);
    add(hash, frame->pixels.reflectivity_16);
    add(hash, frame->pixels.depth);
  }
  std::printf("%s\n", hash.hex().c_str());
  return 0;
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  try {
    if (argc == 4 && std::strcmp(argv[1], "replay") == 0) {
      return glint::replayed(argv[2], std::atoi(argv[3]));
    }
    if (argc == 2 && std::strcmp(argv[1], "frames") == 0) return glint::frames();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  std::fprintf(stderr, "expected: replay FILE WORKERS, or frames\n");
  return 2;
}
