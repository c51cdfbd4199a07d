#include "platform/lab/experiments/case_list.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "platform/lab/experiments/estimator_settings.hpp"

namespace glint {
namespace {

using Json = nlohmann::ordered_json;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

std::string figure_text(const Figure& figure) {
  std::string text = figure.name + " " + number(figure.value);
  if (!figure.unit.empty()) text += " " + figure.unit;
  if (figure.bar.kind == Bar::Kind::none) return text;
  text += figure.bar.kind == Bar::Kind::at_most ? " (<= " : " (>= ";
  text += number(figure.bar.limit) + ")";
  return figure.bar.met_by(figure.value) ? text : text + " MISSED";
}

Json bar_json(const Bar& bar) {
  if (bar.kind == Bar::Kind::none) return nullptr;
  return {{bar.kind == Bar::Kind::at_most ? "at_most" : "at_least", bar.limit}};
}

Json figures_json(const std::vector<Figure>& figures) {
  Json json = Json::object();
  for (const Figure& figure : figures) {
    const Json met =
        figure.bar.kind == Bar::Kind::none ? Json(nullptr) : Json(figure.bar.met_by(figure.value));
    json[figure.name] = {
        {"value", std::isfinite(figure.value) ? Json(figure.value) : Json(nullptr)},
        {"unit", figure.unit},
        {"bar", bar_json(figure.bar)},
        {"met", met}};
  }
  return json;
}

}  // namespace

int missed_bars(const CaseList& list) {
  int missed = 0;
  for (const ExperimentCase& one : list.cases) {
    missed += static_cast<int>(
        std::count_if(one.figures.begin(), one.figures.end(),
                      [](const Figure& figure) { return !figure.bar.met_by(figure.value); }));
  }
  return missed;
}

std::string case_table(const CaseList& list) {
  std::size_t case_width = 4, method_width = 6;
  for (const ExperimentCase& one : list.cases) {
    case_width = std::max(case_width, one.name.size());
    method_width = std::max(method_width, one.method.size());
  }
  std::string table =
      padded("case", case_width) + "  " + padded("method", method_width) + "         n  figures\n";
  for (const ExperimentCase& one : list.cases) {
    char n[24];
    std::snprintf(n, sizeof n, "%10lld", static_cast<long long>(one.n));
    table += padded(one.name, case_width) + "  " + padded(one.method, method_width) + n;
    const char* between = "  ";
    for (const Figure& figure : one.figures) {
      table += between + figure_text(figure);
      between = ", ";
    }
    table += "\n";
  }
  const int missed = missed_bars(list);
  return table +
         (missed == 0 ? "all bars met\n" : std::to_string(missed) + " figures miss their bar\n");
}

std::string case_json(const CaseList& list, const CaseOptions& options) {
  Json cases = Json::array();
  for (const ExperimentCase& one : list.cases) {
    cases.push_back({{"case", one.name},
                     {"method", one.method},
                     {"n", one.n},
                     {"figures", figures_json(one.figures)}});
  }
  const Json json = {{"experiment", list.experiment},
                     {"config_hash", estimator_hash()},
                     {"config", Json::parse(estimator_text())},
                     {"quick", options.quick},
                     {"seed", options.seed},
                     {"missed", missed_bars(list)},
                     {"cases", cases}};
  return json.dump(1) + "\n";
}

}  // namespace glint
