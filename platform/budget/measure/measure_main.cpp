// glint_measure: runs kernels on numbered inputs and writes each call's loop counts and cost.
//
//   glint_measure --list            # its build, then its kernels
//   glint_measure --kernel FindBlobs --inputs 10000 --counter time|marks --out FILE
//     [--cache warm|cold] [--interference cache] [--repeat 7]
//
// It links only the kernels and reads no other files. It therefore runs on a bare computer and,
// with `marks`, in an emulator that counts the instructions between two markers.
//
// Output file: "loops NAME..", "worst LIMITS COUNT.." for each set of limits, then for each input
// "input LIMITS KIND NUMBER COUNT.. COST", COST in nanoseconds. With `marks`, COST is 0; the
// counter's file has one number for an initial empty call and one for each input.
#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "glint_build_signature.hpp"
#include "platform/budget/measure/cycle_clock.hpp"
#include "platform/budget/measure/input_numbers.hpp"
#include "platform/budget/measure/interference_load.hpp"
#include "platform/budget/measure/markers.hpp"
#include "platform/budget/measure/measured_limits.hpp"

namespace glint {
namespace {

constexpr std::size_t k_evicting_bytes = 16u << 20;  // larger than the private caches of a core

struct MeasureArguments {
  std::string kernel, out, counter = "time", cache = "warm", load = "none";
  std::uint64_t inputs = 1000;
  int repeat = 7;
  bool list = false;
};

// Its measured cost is the overhead of the measurement.
class EmptyKernel : public MeasuredKernel {
 public:
  [[nodiscard]] std::string_view name() const override { return "empty"; }
  [[nodiscard]] std::span<const std::string_view> loops() const override { return {}; }
  [[nodiscard]] graph::LoopCounts worst(const Limits& /*limits*/) const override { return {}; }
  void set_input(InputKind /*kind*/, std::uint64_t /*number*/, const Limits& /*limits*/) override {}
  void run() noexcept override {}
  [[nodiscard]] graph::LoopCounts counts() const override { return {}; }
};

class Meter {
 public:
  explicit Meter(const MeasureArguments& arguments)
      : marks_(arguments.counter == "marks"),
        cold_(arguments.cache == "cold"),
        repeat_(arguments.repeat) {
    if (cold_) evicting_.resize(k_evicting_bytes, 1);
    EmptyKernel empty;
    if (marks_) {
      (void)cost_of_input(empty);
      return;
    }
    stay_on_core(k_measured_core);
    ns_of_a_count_ = nanoseconds_per_count();
    step_counts_ = static_cast<double>(counter_step());
    repeat_ = 1001;
    empty_counts_ = median_counts(empty);
    repeat_ = arguments.repeat;
  }

  // Cost in nanoseconds; with marks 0, while the external counter counts one call.
  [[gnu::noinline]] double cost_of_input(MeasuredKernel& kernel) {
    if (marks_) {
      kernel.rewind();
      glint_measure_begin();
      kernel.run();
      glint_measure_end();
      return 0;
    }
    return (std::max(0.0, median_counts(kernel) - empty_counts_) + step_counts_) * ns_of_a_count_;
  }

 private:
  [[gnu::noinline]] double median_counts(MeasuredKernel& kernel) {
    counts_.clear();
    if (!cold_) {
      kernel.rewind();
      kernel.run();
    }
    for (int i = 0; i < repeat_; ++i) {
      kernel.rewind();
      for (std::size_t byte = 0; byte < evicting_.size(); byte += 64) evicting_[byte] += 1;
      const std::uint64_t begin = serialised_count();
      kernel.run();
      counts_.push_back(static_cast<double>(serialised_count() - begin));
    }
    const auto middle = counts_.begin() + static_cast<std::ptrdiff_t>(counts_.size() / 2);
    std::nth_element(counts_.begin(), middle, counts_.end());
    return *middle;
  }

  bool marks_;
  bool cold_;
  int repeat_;
  double ns_of_a_count_ = 1;
  double empty_counts_ = 0;
  double step_counts_ = 0;  // maximum lag of a reading; added to each call
  std::vector<unsigned char> evicting_;
  std::vector<double> counts_;
};

void write_counts(std::FILE* out, const graph::LoopCounts& counts, std::size_t loops) {
  for (std::size_t loop = 0; loop < loops; ++loop) std::fprintf(out, " %" PRId64, counts[loop]);
}

bool measure(MeasuredKernel& kernel, const MeasureArguments& arguments) {
  std::FILE* out = std::fopen(arguments.out.c_str(), "w");
  if (out == nullptr) {
    std::fprintf(stderr, "glint_measure: %s cannot be written\n", arguments.out.c_str());
    return false;
  }
  const auto limits = measured_limits();
  const std::size_t loops = kernel.loops().size();
  std::fprintf(out, "loops");
  for (const std::string_view loop : kernel.loops()) {
    std::fprintf(out, " %.*s", static_cast<int>(loop.size()), loop.data());
  }
  for (std::size_t i = 0; i < limits.size(); ++i) {
    std::fprintf(out, "\nworst %zu", i);
    write_counts(out, kernel.worst(limits[i]), loops);
  }
  std::fprintf(out, "\n");
  const InterferenceLoad load(arguments.load);
  Meter meter(arguments);
  for (std::uint64_t running = 0; running < arguments.inputs; ++running) {
    const MeasuredInput input = input_of(running);
    kernel.set_input(input.kind, input.number, limits[input.limits]);
    const double cost = meter.cost_of_input(kernel);
    const std::string_view kind = name_of(input.kind);
    std::fprintf(out, "input %" PRIu64 " %.*s %" PRIu64, input.limits,
                 static_cast<int>(kind.size()), kind.data(), input.number);
    write_counts(out, kernel.counts(), loops);
    std::fprintf(out, " %.1f\n", cost);
  }
  const bool written = std::ferror(out) == 0;
  return std::fclose(out) == 0 && written;
}

bool parse(int argc, char** argv, MeasureArguments& arguments) {
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--list") {
      arguments.list = true;
      continue;
    }
    if (i + 1 >= argc) return false;
    const char* value = argv[++i];
    if (name == "--kernel") {
      arguments.kernel = value;
    } else if (name == "--out") {
      arguments.out = value;
    } else if (name == "--counter") {
      arguments.counter = value;
    } else if (name == "--cache") {
      arguments.cache = value;
    } else if (name == "--interference") {
      arguments.load = value;
    } else if (name == "--inputs") {
      arguments.inputs = std::strtoull(value, nullptr, 10);
    } else if (name == "--repeat") {
      arguments.repeat = std::max(1, std::atoi(value));
    } else {
      return false;
    }
  }
  return arguments.list || (!arguments.kernel.empty() && !arguments.out.empty());
}

int run(int argc, char** argv) {
  MeasureArguments arguments;
  if (!parse(argc, argv, arguments)) {
    std::fprintf(
        stderr,
        "glint_measure: expected --list, or --kernel NAME --out FILE [--inputs N]"
        " [--counter time|marks] [--cache warm|cold] [--interference NAME] [--repeat N]\n");
    return 2;
  }
  if (arguments.list) {
    std::printf("%.*s\n", static_cast<int>(k_build_signature.size()), k_build_signature.data());
  }
  for (const std::unique_ptr<MeasuredKernel>& kernel : measured_kernels()) {
    if (arguments.list) {
      std::printf("%.*s\n", static_cast<int>(kernel->name().size()), kernel->name().data());
    } else if (kernel->name() == arguments.kernel) {
      return measure(*kernel, arguments) ? 0 : 1;
    }
  }
  if (arguments.list) return 0;
  std::fprintf(stderr, "glint_measure: unknown kernel \"%s\"; see --list\n",
               arguments.kernel.c_str());
  return 2;
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) { return glint::run(argc, argv); }
