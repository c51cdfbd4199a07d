// Registry of the experiments that return a list of cases, by name. A new experiment is a line in
// the table of case_experiments.cpp.
#pragma once

#include <span>

#include "platform/lab/experiments/case_list.hpp"

namespace glint {

// Whether an experiment reads recordings: --data DIR.
enum class DataFolder { none, optional, required };

struct CaseExperiment {
  const char* name;  // name of the subcommand
  const char* what;  // one line of help
  DataFolder data = DataFolder::none;
  CaseList (*run)(const CaseOptions& options) = nullptr;
  bool accepts_tries = false;  // accepts --tries N
};

[[nodiscard]] std::span<const CaseExperiment> case_experiments();

}  // namespace glint
