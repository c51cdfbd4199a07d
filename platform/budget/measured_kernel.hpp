// A kernel as `glint budget measure` sees it: inputs by number, one call, and its loop counts.
//
// Each kernel ships the inputs that are typical for it, the one that drives every loop to its
// maximum, and a search that tries to beat that one. All of them follow from a number alone, so
// that every machine and every run measures the same.
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
  typical,   // drawn at random like a day's work
  recorded,  // from simulated or recorded frames
  worst,     // every loop at its declared maximum, in a few variants
  searched,  // the best that a bounded search found, starting from input `number`
};
[[nodiscard]] constexpr bool at_its_worst(InputKind kind) {
  return kind == InputKind::worst || kind == InputKind::searched;
}

class MeasuredKernel {
 public:
  virtual ~MeasuredKernel() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;  // of its node: "FindBlobs"
  [[nodiscard]] virtual std::span<const std::string_view> loops() const = 0;
  [[nodiscard]] virtual graph::LoopCounts worst(const Limits& limits) const = 0;

  // Builds input `number` of a kind; run() then works on it. May allocate and take its time.
  virtual void set_input(InputKind kind, std::uint64_t number, const Limits& limits) = 0;
  // Back to the state that set_input left, so that every run() of one input does the same.
  virtual void rewind() {}
  // The kernel's call and nothing else.
  virtual void run() noexcept = 0;
  [[nodiscard]] virtual graph::LoopCounts counts() const = 0;
};

// One of each kernel, in the order in which a frame and a tick meet them.
[[nodiscard]] std::vector<std::unique_ptr<MeasuredKernel>> measured_kernels();

// The parts of that list, by the room of their kernels.
void add_image_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels);
void add_pose_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels);
void add_output_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels);
void add_background_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels);
void add_following_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels);

}  // namespace glint
