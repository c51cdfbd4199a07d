#include "platform/budget/inputs/image_inputs.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "tests/unit/repetitions.hpp"

namespace glint {
namespace {

constexpr InputKind k_kinds[] = {InputKind::typical, InputKind::recorded, InputKind::worst,
                                 InputKind::searched};

std::vector<Limits> several_limits() {
  Limits cell;
  cell.tools = 5;
  cell.blobs = 64;
  cell.markers_per_tool = 5;
  cell.runs_per_band = 512;
  Limits small = cell;
  small.width = 448;
  small.height = 450;
  small.reflectivity_bytes = 1;
  small.tools = 1;
  small.blobs = 20;
  small.runs_per_band = 300;
  return {Limits{}, cell, small};
}

std::vector<std::unique_ptr<MeasuredKernel>> image_kernels() {
  std::vector<std::unique_ptr<MeasuredKernel>> kernels;
  add_image_kernels(kernels);
  return kernels;
}

TEST(ImageInputs, NeverDriveALoopBeyondItsMaximum) {
  for (const auto& kernel : image_kernels()) {
    for (const Limits& limits : several_limits()) {
      for (const InputKind kind : k_kinds) {
        for (int number = 0; number < test::repetitions(40, 6); ++number) {
          kernel->set_input(kind, static_cast<std::uint64_t>(number), limits);
          kernel->run();
          const graph::LoopCounts n = kernel->counts(), most = kernel->worst(limits);
          for (std::size_t loop = 0; loop < graph::k_loops_max; ++loop) {
            ASSERT_LE(n[loop], most[loop]) << kernel->name() << " kind " << static_cast<int>(kind)
                                           << " number " << number << " loop " << loop;
          }
        }
      }
    }
  }
}

// The loop whose maximum needs runs that are no candidates: no input reaches it with the others.
constexpr std::string_view k_apart = "rescans";

// One input reaches the maxima of all other loops together: a bound from the maxima is tight.
TEST(ImageInputs, DriveEveryLoopToItsMaximumAtOnce) {
  Limits cell = several_limits()[1];
  for (const auto& kernel : image_kernels()) {
    for (const Limits& limits : {Limits{}, cell}) {
      kernel->set_input(InputKind::worst, 0, limits);
      kernel->run();
      const graph::LoopCounts n = kernel->counts(), most = kernel->worst(limits);
      for (std::size_t loop = 0; loop < kernel->loops().size(); ++loop) {
        if (kernel->loops()[loop] == k_apart) continue;
        EXPECT_EQ(n[loop], most[loop]) << kernel->name() << ' ' << kernel->loops()[loop];
      }
    }
  }
}

TEST(ImageInputs, DriveTheRescansToTheirMaximum) {
  const auto kernel = measured_find_blobs();
  for (const Limits& limits : several_limits()) {
    for (const std::uint64_t number : {10u, 11u}) {
      kernel->set_input(InputKind::worst, number, limits);
      kernel->run();
      ASSERT_EQ(kernel->loops()[5], k_apart);
      EXPECT_GE(kernel->counts()[5], kernel->worst(limits)[5] * 99 / 100) << number;
      EXPECT_GT(kernel->counts()[1], kernel->worst(limits)[1] * 3 / 4) << number;
    }
  }
}

TEST(ImageInputs, FollowFromTheirKindAndNumberAlone) {
  for (const auto& kernel : image_kernels()) {
    for (const InputKind kind : k_kinds) {
      kernel->set_input(kind, 7, Limits{});
      kernel->run();
      const graph::LoopCounts first = kernel->counts();
      kernel->set_input(kind, 8, Limits{});
      kernel->run();
      const auto again = image_kernels();
      for (const auto& fresh : again) {
        if (fresh->name() != kernel->name()) continue;
        fresh->set_input(kind, 7, Limits{});
        fresh->run();
        EXPECT_EQ(fresh->counts().n, first.n) << kernel->name() << static_cast<int>(kind);
        fresh->run();
        EXPECT_EQ(fresh->counts().n, first.n) << "a second run does the same";
      }
    }
  }
}

TEST(ImageInputs, NameAsManyLoopsAsTheyCount) {
  for (const auto& kernel : image_kernels()) {
    const graph::LoopCounts most = kernel->worst(Limits{});
    EXPECT_EQ(most[0], 1) << kernel->name();
    for (std::size_t loop = 0; loop < graph::k_loops_max; ++loop) {
      EXPECT_EQ(most[loop] > 0, loop < kernel->loops().size()) << kernel->name() << loop;
    }
  }
}

}  // namespace
}  // namespace glint
