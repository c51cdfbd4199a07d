// Task model of the scheduler: groups of nodes with execution time bounds, releases and deadlines.
//
// Times are int64 nanoseconds. All values are bounds or declared; none is measured.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace glint {

// One node, or one copy of a split node.
struct TaskNode {
  std::string name;  // "RoiThreshold"
  int copy = 0;      // index of the copy
  int copies = 1;
  std::int64_t bound_ns = 0;  // worst-case execution time: maximum counts times the board's costs
  std::vector<int> after;  // predecessors: indices of nodes of the same group whose data it reads
};

// Nodes with a common release. On a core a higher priority preempts a lower one at once.
struct TaskGroup {
  std::string name;              // "frame", "tick", "background"
  int priority = 0;              // SCHED_FIFO scale: larger is a higher priority
  std::int64_t min_gap_ns = 0;   // minimum between releases: the period, or the sporadic minimum
  std::int64_t jitter_ns = 0;    // maximum delay of a release after its nominal time
  std::int64_t deadline_ns = 0;  // from the nominal release, at most min_gap_ns
  bool resumable = false;        // background work in slices, below every other group
  std::int64_t longest_slice_ns = 0;  // longest non-preemptive run of such a group; else 0
  int can_writes = 0;                 // CAN frames written by an activation after its nodes
  std::vector<TaskNode> nodes;        // in topological order of `after`
};

// Overhead of the operating system. An estimate, measured on the board, reported in its own rows.
struct SystemShare {
  std::int64_t wake_up_ns = 0;           // release -> first instruction of the group
  std::int64_t interrupt_ns = 0;         // each timer interrupt on a core ...
  std::int64_t interrupt_gap_ns = 0;     // ... at least this far apart; 0: none
  std::int64_t can_write_ns = 0;         // one write of one CAN frame
  std::int64_t inter_core_delay_ns = 0;  // end of a node -> visible to its reader on another core
};

struct TaskModel {
  int cores = 1;
  std::vector<TaskGroup> groups;
  SystemShare system;
};

}  // namespace glint
