// Typical load of a group: median execution times of its nodes in a run.
#pragma once

#include <string>

#include "schedules/task_model.hpp"

namespace glint {

// Replaces each node's bound by the median of its spans in a trace file. All copies of a split get
// the largest of their medians, since the longest copy varies. A group that runs in slices keeps
// its declared bound. The result is observed, not a bound. Throws InputError for a trace of other
// nodes, or without spans of one.
[[nodiscard]] TaskModel typical_load(const TaskModel& model, const std::string& trace_file);

}  // namespace glint
