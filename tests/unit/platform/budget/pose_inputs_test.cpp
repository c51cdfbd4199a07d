// Inputs of the pose, output and background kernels: they stay within the declared loop maxima, and
// the worst input reaches all of them.
#include <gtest/gtest.h>

#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "platform/budget/measured_kernel.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint {
namespace {

using Kernels = std::vector<std::unique_ptr<MeasuredKernel>>;

Kernels unsliced_kernels() {
  Kernels kernels;
  add_pose_kernels(kernels);
  add_output_kernels(kernels);
  return kernels;
}
// Kernels that stop when their steps are used up.
Kernels sliced_kernels() {
  Kernels kernels;
  add_background_kernels(kernels);
  add_following_kernels(kernels);
  return kernels;
}
Kernels all_kernels() {
  Kernels kernels = unsliced_kernels();
  add_background_kernels(kernels);
  add_following_kernels(kernels);
  return kernels;
}

Limits five_tools() {
  Limits limits;
  limits.tools = 5;
  limits.markers_per_tool = 5;
  limits.blobs = 64;
  limits.lens_steps = 0;
  limits.search_steps = 768;
  return limits;
}

Limits one_tool() {
  Limits limits = five_tools();
  limits.tools = 1;
  limits.markers_per_tool = 4;
  limits.lens_steps = k_lens_steps_max;
  limits.background_steps = limits.tracking_steps = 100;
  return limits;
}

const std::vector<Limits>& all_limits() {
  static const std::vector<Limits> limits = {Limits{}, five_tools(), one_tool()};
  return limits;
}

std::string shown(const MeasuredKernel& kernel, const graph::LoopCounts& counts) {
  std::ostringstream text;
  text << kernel.name();
  for (std::size_t loop = 0; loop < kernel.loops().size(); ++loop) {
    text << ' ' << kernel.loops()[loop] << '=' << counts[loop];
  }
  return text.str();
}

TEST(PoseInputs, WorstDrivesEveryLoopToItsMaximum) {
  for (const auto& kernel : unsliced_kernels()) {
    for (const Limits& limits : all_limits()) {
      kernel->set_input(InputKind::worst, 0, limits);
      kernel->rewind();
      kernel->run();
      EXPECT_EQ(kernel->counts(), kernel->worst(limits))
          << shown(*kernel, kernel->counts()) << "\nof " << shown(*kernel, kernel->worst(limits));
    }
  }
}

// A slice with work left exceeds its steps by its last item only.
TEST(BackgroundInputs, WorstUsesAllStepsOfASlice) {
  for (const auto& kernel : sliced_kernels()) {
    for (const Limits& limits : all_limits()) {
      kernel->set_input(InputKind::worst, 0, limits);
      kernel->rewind();
      kernel->run();
      EXPECT_GE(kernel->counts()[1], limits.background_steps) << kernel->name();
      EXPECT_TRUE(graph::within(kernel->counts(), kernel->worst(limits)))
          << shown(*kernel, kernel->counts());
    }
  }
}

TEST(PoseInputs, NoInputRunsALoopMoreOftenThanItMay) {
  constexpr InputKind k_all_kinds[] = {InputKind::typical, InputKind::recorded, InputKind::worst,
                                       InputKind::searched};
  for (const auto& kernel : all_kernels()) {
    for (const Limits& limits : all_limits()) {
      for (const InputKind kind : k_all_kinds) {
        for (int number = 0; number < test::repetitions(24, 4); ++number) {
          kernel->set_input(kind, static_cast<std::uint64_t>(number), limits);
          kernel->run();
          ASSERT_TRUE(graph::within(kernel->counts(), kernel->worst(limits)))
              << shown(*kernel, kernel->counts()) << " kind " << static_cast<int>(kind)
              << " number " << number;
        }
      }
    }
  }
}

TEST(PoseInputs, AnInputDoesTheSameEachTimeItRuns) {
  for (const auto& kernel : all_kernels()) {
    for (std::uint64_t number = 0; number < 6; ++number) {
      kernel->set_input(InputKind::searched, number, five_tools());
      kernel->run();
      const graph::LoopCounts once = kernel->counts();
      kernel->rewind();
      kernel->run();
      EXPECT_EQ(kernel->counts(), once) << kernel->name();
      kernel->set_input(InputKind::typical, 1, Limits{});
      kernel->run();
      kernel->set_input(InputKind::searched, number, five_tools());
      kernel->run();
      EXPECT_EQ(kernel->counts(), once) << kernel->name();
    }
  }
}

}  // namespace
}  // namespace glint
