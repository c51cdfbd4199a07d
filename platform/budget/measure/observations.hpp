// What measuring found: for every kernel its loops, their maxima, and each call's counts and cost.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "platform/budget/measure/input_numbers.hpp"
#include "schedules/envelope.hpp"

namespace glint {

struct Observation {
  MeasuredInput input;
  ObservedCall call;
};

struct KernelObservations {
  std::string name;
  std::vector<std::string> loops;
  std::array<graph::LoopCounts, k_limit_sets> worst{};
  std::vector<Observation> calls;
};

struct MeasureRequest {
  std::string program;  // glint_measure of the architecture
  bool count_instructions = true;
  std::string emulator;   // "qemu-aarch64"; empty: none
  std::string cpu_model;  // its processor: what a program's start-up code chooses by
  std::string plugin;     // glint_count_instructions.so
  std::string kernel;     // empty: all
  std::string cache = "warm", enemy = "none";
  std::uint64_t inputs = 10'000;
  int jobs = 1;
};

struct Observations {
  std::string build;  // of the program that ran
  std::vector<KernelObservations> kernels;
};

// Runs the program once for each kernel, in a folder of its own that is removed afterwards, with no
// environment and without address randomisation, so that its memory lies the same in every run.
// Calls progress(done, all). Throws InputError for what a user can mend, MissingDevice where the
// emulator or the program is not there.
[[nodiscard]] Observations measure(const MeasureRequest& request,
                                   const std::function<void(int, int)>& progress);

// Keeps the lesser cost of each call. Times of several passes: minutes apart a shared machine's
// neighbours are others, and what they take is not the kernel's own. Throws InputError where a call
// of the other pass did something else.
void keep_least(Observations& kept, const Observations& pass);

// One kernel's file, with the costs of `counted` (an empty call first) where it is not empty.
// Throws InputError where the two do not belong together.
[[nodiscard]] KernelObservations parse_observations(const std::string& name,
                                                    const std::string& file,
                                                    const std::string& text,
                                                    const std::vector<std::uint64_t>& counted);

}  // namespace glint
