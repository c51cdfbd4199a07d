#include "platform/apps/glint/measure_request.hpp"

#include <algorithm>
#include <filesystem>
#include <thread>

#include "platform/input_error.hpp"

namespace glint {

std::string advice_above_bound(CostCounter counter, const std::string& made_by) {
  if (counter != CostCounter::time || made_by.find("--cache cold") != std::string::npos) return "";
  return "next     warm-cache costs do not bound a call with cold caches; a board for both:\n"
         "         glint budget measure --count time --cache cold --write BOARD.toml\n";
}

MeasureRequest measure_request(const MeasureTarget& target) {
  MeasureRequest request;
  const bool own = target.arch == k_own_arch;
  const std::string beside = std::filesystem::read_symlink("/proc/self/exe").parent_path().string();
  request.count_instructions = target.count == "instructions";
  if (!request.count_instructions && !own) {
    throw InputError("--count is time and --arch is " + target.arch + "; expected --arch " +
                     k_own_arch + ": an emulator's time is not the machine's");
  }
  request.program = !target.program_file.empty() ? target.program_file
                    : own                        ? beside + "/" + target.program
                          : beside + "/../build-" + target.arch + "/" + target.program;
  request.program = std::filesystem::absolute(request.program).lexically_normal().string();
  if (request.count_instructions) {
    request.emulator = target.arch == "arm64" ? "qemu-aarch64" : "qemu-x86_64";
    request.cpu_model = target.arch == "arm64" ? "cortex-a72" : "qemu64";
    request.plugin = beside + "/glint_count_instructions.so";
  }
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  request.jobs = !request.count_instructions ? 1 : target.jobs > 0 ? target.jobs : cores;
  return request;
}

}  // namespace glint
