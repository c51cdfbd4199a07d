// Common base of all nodes as measured kernels.
#pragma once

#include <type_traits>

#include "platform/budget/measured_kernel.hpp"

namespace glint::inputs {

template <class Node>
class NodeKernel : public MeasuredKernel {
 public:
  explicit NodeKernel(std::string_view name) : name_(name) {}
  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] std::span<const std::string_view> loops() const override { return Node::k_loops; }
  [[nodiscard]] graph::LoopCounts worst(const Limits& limits) const override {
    return Node::worst(limits);
  }
  // A node that cannot be copied has no state that run() changes.
  void rewind() override {
    if constexpr (std::is_copy_assignable_v<Node>) node_ = start_;
  }
  [[nodiscard]] graph::LoopCounts counts() const override { return node_.counts(); }

 protected:
  Node start_;  // state at the start of the input
  Node node_;   // state during run()

 private:
  std::string_view name_;
};

}  // namespace glint::inputs
