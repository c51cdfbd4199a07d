#include <cstring>
#include <sstream>

#include "platform/budget/measure/observations.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

class ObservationParser {
 public:
  ObservationParser(std::string name, const std::string& file,
                    const std::vector<std::uint64_t>& counted)
      : file_(file), counted_(counted) {
    found_.name = std::move(name);
  }

  KernelObservations parse(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    while (std::getline(lines, line)) {
      ++line_;
      std::istringstream words(line);
      std::string what;
      words >> what;
      if (what == "loops") {
        for (std::string loop; words >> loop;) found_.loops.push_back(loop);
        expect(!found_.loops.empty() && found_.loops.size() <= graph::k_loops_max, "1 to 8 loops");
      } else if (what == "worst") {
        read_worst(words);
      } else {
        expect(what == "input", "loops, worst or input");
        read_input(words);
      }
    }
    if (!counted_.empty() && counted_.size() != found_.calls.size() + 1) {
      throw InputError(file_ + ": " + std::to_string(found_.calls.size()) + " inputs, but " +
                       std::to_string(counted_.size()) + " counts; expected one more");
    }
    return std::move(found_);
  }

 private:
  void expect(bool holds, const char* expected) const {
    if (holds) return;
    throw InputError(file_ + ":" + std::to_string(line_) + ": expected " + expected);
  }
  graph::LoopCounts read_counts(std::istringstream& words) const {
    graph::LoopCounts counts;
    for (std::size_t loop = 0; loop < found_.loops.size(); ++loop) words >> counts[loop];
    expect(!words.fail(), "a count for each loop");
    return counts;
  }
  void read_worst(std::istringstream& words) {
    std::size_t limits = 0;
    words >> limits;
    expect(!words.fail() && limits < k_limit_sets, "the number of a set of limits");
    found_.worst[limits] = read_counts(words);
  }
  void read_input(std::istringstream& words) {
    Observation seen;
    std::string kind;
    words >> seen.input.limits >> kind >> seen.input.number;
    bool known = false;
    for (const InputKind one :
         {InputKind::typical, InputKind::recorded, InputKind::worst, InputKind::searched}) {
      if (kind != name_of(one)) continue;
      seen.input.kind = one;
      known = true;
    }
    expect(known && seen.input.limits < k_limit_sets, "limits, kind and number of an input");
    seen.call.counts = read_counts(words);
    words >> seen.call.cost;
    expect(!words.fail(), "a cost at the end");
    const std::size_t index = found_.calls.size() + 1;
    if (index < counted_.size()) {
      // counted[0] is the cost of the markers without a kernel.
      expect(counted_[index] >= counted_[0], "a count that is not below the empty call's");
      seen.call.cost = static_cast<double>(counted_[index] - counted_[0]);
    }
    found_.calls.push_back(seen);
  }

  const std::string& file_;
  const std::vector<std::uint64_t>& counted_;
  int line_ = 0;
  KernelObservations found_;
};

}  // namespace

KernelObservations parse_observations(const std::string& name, const std::string& file,
                                      const std::string& text,
                                      const std::vector<std::uint64_t>& counted) {
  return ObservationParser(name, file, counted).parse(text);
}

}  // namespace glint
