// The experiments that answer with a list of cases, by name. A new one is a line in the table of
// case_experiments.cpp.
#pragma once

#include <span>

#include "platform/experiments/case_list.hpp"

namespace glint {

struct CaseExperiment {
  const char* name;         // of the subcommand
  const char* what;         // one line of help
  bool wants_data = false;  // works on recordings: --data DIR
  CaseList (*run)(const CaseOptions& options) = nullptr;
  bool counts_tries = false;  // takes --tries N
};

[[nodiscard]] std::span<const CaseExperiment> case_experiments();

}  // namespace glint
