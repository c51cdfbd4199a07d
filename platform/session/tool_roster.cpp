#include "platform/session/tool_roster.hpp"

namespace glint {

ToolRoster::ToolRoster(const Cell& cell, ToolRequests* requests)
    : cell_(&cell),
      requests_(requests),
      planned_(cell.tools_at_start),
      there_(cell.tools_at_start) {
  publish(there_, Time{});
}

void ToolRoster::reach(Time now) {
  ToolsPresent there = there_;
  for (; next_ < cell_->tool_changes.size() && cell_->tool_changes[next_].at <= now; ++next_) {
    const ToolsPresent planned = cell_->tool_changes[next_].now_there;
    const auto named = static_cast<ToolsPresent>(planned ^ planned_);
    there = static_cast<ToolsPresent>((there & ~named) | (planned & named));
    planned_ = planned;
  }
  if (requests_ != nullptr) there = requests_->applied_to(there);
  if (there == there_) return;
  there_ = there;
  publish(there, now);
}

void ToolRoster::publish(ToolsPresent there, Time now) {
  published_.write_slot() = tools_present(cell_->tools, there);
  published_.publish(tools_version(++number_, there), now.nanoseconds);
}

}  // namespace glint
