#include "nodes/background.hpp"
#include "platform/budget/inputs/node_kernel.hpp"
#include "platform/budget/inputs/numbers.hpp"

namespace glint {
namespace {

class BackgroundKernel final : public inputs::NodeKernel<BackgroundSlice> {
 public:
  BackgroundKernel() : NodeKernel("BackgroundSlice") {}
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    inputs::Numbers numbers(kind, number);
    start_.limits = limits;
    start_.steps = kind == InputKind::worst || kind == InputKind::searched
                       ? limits.background_steps
                       : 1 + numbers.below(limits.background_steps);
    seed_.value = numbers.bits();
    rewind();
  }
  void run() noexcept override { node_(seed_, digest_); }

 private:
  BackgroundSeed seed_;
  BackgroundDigest digest_;
};

}  // namespace

void add_background_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels) {
  kernels.push_back(std::make_unique<BackgroundKernel>());
}

}  // namespace glint
