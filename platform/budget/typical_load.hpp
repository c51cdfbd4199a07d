// A group's typical load: what its nodes took in a run, by the median.
#pragma once

#include <string>

#include "schedules/task_model.hpp"

namespace glint {

// The model with each node's bound replaced by the median of its spans in a trace file; copies of a
// split, which take turns at being the longest, all get the largest of theirs; what runs in slices
// keeps its bound, for their length is declared. Observed, so that what is made of it is no bound.
// Throws InputError for a trace of other nodes, or without spans of one.
[[nodiscard]] TaskModel typical_load(const TaskModel& model, const std::string& trace_file);

}  // namespace glint
