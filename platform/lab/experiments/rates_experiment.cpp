#include <array>
#include <string>

#include "platform/lab/experiments/motion_experiments.hpp"
#include "platform/lab/experiments/rates_run.hpp"

namespace glint {
namespace {

constexpr int k_rates_runs = 100, k_rates_runs_quick = 2;

struct RatesCase {
  const char* name;
  FrameFaults faults;
};

std::array<RatesCase, 6> cases() {
  std::array<RatesCase, 6> cases = {{{"as they are", {}},
                                     {"10 % dropped", {}},
                                     {"10 % doubled", {}},
                                     {"10 % stamped backwards", {}},
                                     {"jitter", {}},
                                     {"all of these and 10 % late", {}}}};
  cases[1].faults.dropped = 0.1;
  cases[2].faults.duplicated = 0.1;
  cases[3].faults.backward = 0.1;
  cases[4].faults.exposure_jitter = milliseconds(3);
  cases[4].faults.transport_jitter = milliseconds(8);
  cases[5].faults = {0.1, 0.1, 0.1, 0.1, milliseconds(3), milliseconds(8)};
  return cases;
}

std::vector<Figure> consistency_figures(const Consistency& consistency, bool judged) {
  const auto bar = [&](Bar limit) { return judged ? limit : Bar::none(); };
  const double nees = consistency.nees_per_axis(), inside = consistency.inside_95_percent();
  return {{"nees_over_6", "", nees, bar(Bar::at_most(1.4))},
          {"nees_over_6_least", "", nees, bar(Bar::at_least(0.7))},
          {"inside_95", "%", inside, bar(Bar::at_most(98))},
          {"inside_95_least", "%", inside, bar(Bar::at_least(92))}};
}

ExperimentCase graph_case(const std::string& name, const GraphTally& graph) {
  const double right = static_cast<double>(graph.states_correct) / static_cast<double>(graph.ticks);
  return {name,
          "graph",
          graph.ticks,
          {{"states_right", "%", 100 * right, Bar::at_least(100)},
           {"age_error_most", "ms", 1e-6 * static_cast<double>(graph.age_error_max_ns),
            Bar::at_most(0)},
           {"nees_over_6", "", graph.tip.nees_per_axis()},
           {"inside_95", "%", graph.tip.inside_95_percent()}}};
}

}  // namespace

CaseList run_rates(const CaseOptions& options) {
  CaseList list{"rates", {}, {}};
  const int runs = options.quick ? k_rates_runs_quick : k_rates_runs;
  const auto all = cases();
  for (std::size_t k = 0; k < all.size(); ++k) {
    RatesTally tally;
    for (int run = 0; run < runs; ++run)
      tally.add(options.piece([&] {
        return follow_rates({all[k].faults, options.seed, static_cast<std::uint64_t>(run)});
      }));
    for (const Rate rate : {Rate::fast, Rate::slow}) {
      const auto r = static_cast<std::size_t>(rate);
      const std::string name = std::string(rate == Rate::fast ? "45 Hz, " : "5 Hz, ") + all[k].name;
      list.cases.push_back(graph_case(name, tally.graph[r]));
      list.cases.push_back({name, "motion filter", tally.motion[r].n,
                            consistency_figures(tally.motion[r], !options.quick)});
    }
    list.cases.push_back(
        {std::string("both, ") + all[k].name,
         "both",
         tally.accepted + tally.rejected,
         {{"refused", "", static_cast<double>(tally.rejected)},
          {"refused_changed", "", static_cast<double>(tally.rejected_changed), Bar::at_most(0)},
          {"frames_to_measured", "", static_cast<double>(tally.frames_to_measured),
           Bar::at_most(1)}}});
    if (options.progress) options.progress(static_cast<int>(k) + 1, static_cast<int>(all.size()));
  }
  return list;
}

}  // namespace glint
