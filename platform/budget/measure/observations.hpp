// Runs the measuring program; stores each kernel's loops, their maxima, and each call's counts and
// cost.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "platform/budget/measure/input_numbers.hpp"
#include "platform/shards/sharded_work.hpp"
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
  std::string program;  // glint_measure for the architecture
  bool count_instructions = true;
  std::string emulator;   // "qemu-aarch64"; empty: none
  std::string cpu_model;  // emulated processor; a program's start-up code may depend on it
  std::string plugin;     // glint_count_instructions.so
  std::string kernel;     // empty: all
  std::string cache = "warm", load = "none";
  std::uint64_t inputs = 10'000;
  int jobs = 1;
  Pieces piece;  // runs each kernel
};

struct Observations {
  std::string build;  // of the program that ran
  std::vector<KernelObservations> kernels;
};

// Runs the program once per kernel in a temporary folder, without environment and without address
// randomisation, so that its memory layout is the same in every run. Calls progress(done, all).
// A shard returns its own kernels only.
// Throws InputError for errors that a user can correct, MissingDevice if the emulator or the
// program does not exist.
[[nodiscard]] Observations measure(const MeasureRequest& request,
                                   const std::function<void(int, int)>& progress);

// Keeps the smaller cost of each call from several passes. On a shared machine, other processes
// differ between passes, and their time is not the kernel's. Throws InputError if a call of the
// other pass has other counts.
void keep_minimum(Observations& kept, const Observations& pass);

// Parses one kernel's file, with the costs of `counted` (an empty call first) if it is not empty.
// Throws InputError if the two do not match.
[[nodiscard]] KernelObservations parse_observations(const std::string& name,
                                                    const std::string& file,
                                                    const std::string& text,
                                                    const std::vector<std::uint64_t>& counted);

}  // namespace glint
