// Kernel of known work instead of Glint's own: each count of its loop is one step of a generator,
// and its worst input takes as many steps as the maximum number of blobs.
#include <array>

#include "platform/budget/measured_kernel.hpp"

namespace glint {
namespace {

class ToyKernel : public MeasuredKernel {
 public:
  [[nodiscard]] std::string_view name() const override { return "Toy"; }
  [[nodiscard]] std::span<const std::string_view> loops() const override { return k_loops; }
  [[nodiscard]] graph::LoopCounts worst(const Limits& limits) const override {
    return {{1, limits.blobs}};
  }
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    const auto most = static_cast<std::uint64_t>(limits.blobs);
    steps_ = kind == InputKind::worst ? most : number * 2654435761u % (most + 1);
  }
  void run() noexcept override {
    for (std::uint64_t i = 0; i < steps_; ++i) state_ = state_ * 3 + 1;
  }
  [[nodiscard]] graph::LoopCounts counts() const override {
    return {{1, static_cast<std::int64_t>(steps_)}};
  }

 private:
  static constexpr std::array<std::string_view, 2> k_loops = {"call", "steps"};
  std::uint64_t steps_ = 0;
  volatile std::uint64_t state_ = 1;
};

}  // namespace

std::vector<std::unique_ptr<MeasuredKernel>> measured_kernels() {
  std::vector<std::unique_ptr<MeasuredKernel>> kernels;
  kernels.push_back(std::make_unique<ToyKernel>());
  return kernels;
}

}  // namespace glint
