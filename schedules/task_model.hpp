// What is to be scheduled, as numbers: groups of nodes with bounds, and when they are released.
//
// Times are int64 nanoseconds. Everything here is a bound, or is declared; nothing is measured.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace glint {

// One node, or one copy of a split one.
struct TaskNode {
  std::string name;  // "RoiThreshold"
  int copy = 0;      // which copy of a split
  int copies = 1;
  std::int64_t bound_ns = 0;  // counts at their maxima times the board's costs
  std::vector<int> after;     // nodes of the same group, by index, whose data it reads
};

// Nodes that are released together. On a core a higher priority preempts a lower one at once.
struct TaskGroup {
  std::string name;                   // "frame", "tick", "background"
  int priority = 0;                   // SCHED_FIFO's scale: larger is more urgent
  std::int64_t min_gap_ns = 0;        // between releases: the period, or the sporadic minimum
  std::int64_t jitter_ns = 0;         // how late a release may come after its nominal time
  std::int64_t deadline_ns = 0;       // from the nominal release, at most min_gap_ns
  bool resumable = false;             // the background: runs in slices, below every other group
  std::int64_t longest_slice_ns = 0;  // the longest run that such a group does not give up; else 0
  int can_writes = 0;                 // CAN frames that an activation writes after its nodes
  std::vector<TaskNode> nodes;        // in an order that respects `after`
};

// What the operating system adds. An estimate, measured on the board, kept in rows of its own.
struct SystemShare {
  std::int64_t wake_up_ns = 0;        // release -> first instruction of the group
  std::int64_t interrupt_ns = 0;      // each timer interrupt on a core ...
  std::int64_t interrupt_gap_ns = 0;  // ... at least this far apart; 0: there are none
  std::int64_t can_write_ns = 0;      // one write of one CAN frame
  std::int64_t core_handover_ns = 0;  // a node's end on one core -> its reader sees it on another
};

struct TaskModel {
  int cores = 1;
  std::vector<TaskGroup> groups;
  SystemShare system;
};

}  // namespace glint
