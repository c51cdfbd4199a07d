// Interface of a kernel for `glint budget measure`: numbered inputs, one call, and its loop counts.
//
// Each kernel has typical inputs, an input that drives every loop to its maximum, and a search for
// a worse one. All depend only on a number, so that every machine and every run measures the same.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "graph/loops.hpp"
#include "kernels/limits.hpp"

namespace glint {

enum class InputKind : std::uint8_t {
  typical,   // random, as in normal use
  recorded,  // from simulated or recorded frames
  worst,     // every loop at its declared maximum, in several variants
  searched,  // worst result of a bounded search from input `number`
};
[[nodiscard]] constexpr bool is_worst_case(InputKind kind) {
  return kind == InputKind::worst || kind == InputKind::searched;
}

class MeasuredKernel {
 public:
  virtual ~MeasuredKernel() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;  // of its node: "FindBlobs"
  [[nodiscard]] virtual std::span<const std::string_view> loops() const = 0;
  [[nodiscard]] virtual graph::LoopCounts worst(const Limits& limits) const = 0;

  // Builds input `number` of a kind for run(). May allocate; not time-critical.
  virtual void set_input(InputKind kind, std::uint64_t number, const Limits& limits) = 0;
  // Restores the state after set_input(), so that every run() of one input does the same work.
  virtual void rewind() {}
  // Only the kernel's call.
  virtual void run() noexcept = 0;
  [[nodiscard]] virtual graph::LoopCounts counts() const = 0;
};

// One of each kernel, in the order of the frame and tick graphs.
[[nodiscard]] std::vector<std::unique_ptr<MeasuredKernel>> measured_kernels();

// The parts of that list, by folder of the kernels.
void add_image_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels);
void add_pose_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels);
void add_output_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels);
void add_background_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels);
void add_following_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels);

}  // namespace glint
