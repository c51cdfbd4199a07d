#include "platform/budget/compare/budget_diff.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "platform/budget/compare/two_samples.hpp"
#include "platform/budget/report/json_view.hpp"
#include "platform/budget/report/run_observations.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

struct Series {
  std::string name;
  std::vector<double> values;
};

bool is_measurement(const std::string& path) {
  return std::filesystem::path(path).extension() == ".json";
}

void judge_times(const Series& before, const Series& after, const DiffSettings& settings,
                 BudgetDiff& diff) {
  DiffRow row{before.name, "median", 0, 0};
  const RatioInterval interval = median_ratio(before.values, after.values, diff.row_confidence,
                                              settings.resamples, 1 + diff.rows.size());
  std::vector<double> sorted = before.values;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  row.before = *middle;
  row.after = row.before * interval.ratio;
  row.low = interval.low;
  row.high = interval.high;
  row.p = mann_whitney(before.values, after.values);
  const bool differs = row.p < 1 - diff.row_confidence;
  row.change = differs && row.low > 1    ? Change::slower
               : differs && row.high < 1 ? Change::faster
                                         : Change::not_significant;
  row.significantly_slower =
      row.change == Change::slower && row.low > 1 + settings.tolerance_percent / 100;
  diff.rows.push_back(row);
}

void judge_counts(const std::string& name, const char* what, double before, double after,
                  const DiffSettings& settings, BudgetDiff& diff) {
  const double ratio = before > 0 ? after / before : after > 0 ? 1e9 : 1;
  DiffRow row{name, what, before, after, ratio, ratio, before == after ? 1.0 : 0.0};
  row.change = after > before ? Change::slower : after < before ? Change::faster : Change::same;
  row.significantly_slower = ratio > 1 + settings.tolerance_percent / 100;
  diff.rows.push_back(row);
}

// Values of a histogram at their bins' centres; resolution: the bin width, which a report states.
std::vector<double> values_of(const JsonView& kernel) {
  std::vector<double> values;
  if (!kernel.has("histogram")) return values;
  const JsonView histogram = kernel.at("histogram");
  double centre = histogram.number("low") + 0.5 * histogram.number("width");
  for (const JsonView& count : histogram.list("counts")) {
    values.insert(values.end(), static_cast<std::size_t>(count.as_number()), centre);
    centre += histogram.number("width");
  }
  return values;
}

// Pairs the items with equal names; lists the others.
template <class Item, class Judge>
void pair_up(const std::vector<Item>& before, const std::vector<Item>& after,
             const std::string& (*name)(const Item&), BudgetDiff& diff, Judge&& judge) {
  std::map<std::string, const Item*> others;
  for (const Item& item : after) others[name(item)] = &item;
  for (const Item& item : before) {
    const auto found = others.find(name(item));
    if (found == others.end()) {
      diff.only_before.push_back(name(item));
      continue;
    }
    judge(item, *found->second);
    others.erase(found);
  }
  for (const auto& [left, item] : others) diff.only_after.push_back(left);
}

// Confidence per row for a given joint confidence (Bonferroni).
double confidence_of_each(const DiffSettings& settings, std::size_t rows) {
  return 1 - (1 - settings.confidence) / static_cast<double>(std::max<std::size_t>(1, rows));
}

struct NamedKernel {
  std::string name;
  JsonView view;
};

std::vector<NamedKernel> kernels_of(const JsonView& measure) {
  std::vector<NamedKernel> kernels;
  for (const JsonView& kernel : measure.list("kernels")) {
    kernels.push_back({kernel.text("name"), kernel});
  }
  return kernels;
}

BudgetDiff diff_measurements(const std::string& before, const std::string& after,
                             const DiffSettings& settings) {
  const JsonView a = JsonView::of_file(before), b = JsonView::of_file(after);
  for (const char* key : {"count", "unit"}) {
    if (a.text(key) != b.text(key)) {
      throw InputError(after + ": " + key + " is " + b.text(key) + "; expected " + a.text(key) +
                       " as in " + before);
    }
  }
  BudgetDiff diff;
  diff.unit = a.text("unit");
  diff.exact = a.text("count") == "instructions";
  const std::vector<NamedKernel> kernels = kernels_of(a);
  diff.row_confidence = diff.exact ? 1 : confidence_of_each(settings, kernels.size());
  pair_up<NamedKernel>(
      kernels, kernels_of(b),
      [](const NamedKernel& kernel) -> const std::string& { return kernel.name; }, diff,
      [&](const NamedKernel& x, const NamedKernel& y) {
        judge_counts(x.name, "bound", x.view.number("bound"), y.view.number("bound"), settings,
                     diff);
        // A bound of times is an envelope of noise: it is shown; the times below are judged.
        if (!diff.exact) diff.rows.back().significantly_slower = false;
        if (diff.exact) {
          judge_counts(x.name, "largest", x.view.number("observed_max"),
                       y.view.number("observed_max"), settings, diff);
          return;
        }
        const Series u{x.name, values_of(x.view)}, v{y.name, values_of(y.view)};
        if (!u.values.empty() && !v.values.empty()) judge_times(u, v, settings, diff);
      });
  return diff;
}

std::vector<Series> series_of(const std::string& path) {
  const bool folder = std::filesystem::is_directory(path);
  const RunObservations run =
      observe(read_trace(folder ? (std::filesystem::path(path) / "trace.spans").string() : path));
  std::vector<Series> all;
  for (const NodeTimes& node : run.nodes) {
    if (!node.us.empty()) all.push_back({node.group + " " + node.node, node.us});
  }
  Series frames{"frame to CAN", {}};
  for (const FrameLatency& frame : run.frames) frames.values.push_back(frame.us);
  if (!frames.values.empty()) all.push_back(std::move(frames));
  return all;
}

BudgetDiff diff_runs(const std::string& before, const std::string& after,
                     const DiffSettings& settings) {
  BudgetDiff diff;
  diff.unit = "us";
  const std::vector<Series> a = series_of(before);
  diff.row_confidence = confidence_of_each(settings, a.size());
  pair_up<Series>(
      a, series_of(after), [](const Series& s) -> const std::string& { return s.name; }, diff,
      [&](const Series& x, const Series& y) { judge_times(x, y, settings, diff); });
  return diff;
}

}  // namespace

bool BudgetDiff::worse() const {
  return std::any_of(rows.begin(), rows.end(),
                     [](const DiffRow& row) { return row.significantly_slower; });
}

BudgetDiff budget_diff(const std::string& before, const std::string& after,
                       const DiffSettings& settings) {
  if (is_measurement(before) != is_measurement(after)) {
    throw InputError(after + ": kind differs from " + before +
                     "; expected two measurements (.json) or two runs (folder or trace.spans)");
  }
  return is_measurement(before) ? diff_measurements(before, after, settings)
                                : diff_runs(before, after, settings);
}

std::string name_of(Change change) {
  constexpr const char* names[] = {"same", "faster", "slower", "no difference detected"};
  return names[static_cast<std::size_t>(change)];
}

nlohmann::ordered_json as_json(const BudgetDiff& diff) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const DiffRow& row : diff.rows) {
    rows.push_back({{"name", row.name},
                    {"what", row.what},
                    {"before", row.before},
                    {"after", row.after},
                    {"ratio_low", row.low},
                    {"ratio_high", row.high},
                    {"p", row.p},
                    {"change", name_of(row.change)},
                    {"worse_beyond_tolerance", row.significantly_slower}});
  }
  return {{"unit", diff.unit},
          {"exact", diff.exact},
          {"row_confidence", diff.row_confidence},
          {"worse", diff.worse()},
          {"rows", rows},
          {"only_before", diff.only_before},
          {"only_after", diff.only_after}};
}

}  // namespace glint
