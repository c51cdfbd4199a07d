#include "schedules/plan_check.hpp"

#include <algorithm>

#include "schedules/group_response.hpp"

namespace glint {
namespace {

std::string ns(std::int64_t value) { return std::to_string(value) + " ns"; }

class Checker {
 public:
  Checker(const Plan& plan, const TaskModel& model) : plan_(plan), model_(model) {}

  std::vector<std::string> run() {
    if (plan_.groups.size() != model_.groups.size()) {
      add("plan: " + std::to_string(plan_.groups.size()) + " groups; expected " +
          std::to_string(model_.groups.size()));
      return faults_;
    }
    check_priorities();
    for (std::size_t g = 0; g < model_.groups.size(); ++g) {
      if (!check_allocation(g)) continue;
      check_precedence(g);
      check_overlap(g);
      check_one_core(g);
    }
    if (faults_.empty()) check_capacity();
    if (const auto complaint = check_bus_load(plan_.traffic, plan_.bus)) add(*complaint);
    return faults_;
  }

 private:
  void add(std::string fault) { faults_.push_back(std::move(fault)); }

  [[nodiscard]] std::string name(std::size_t g, std::size_t n) const {
    return model_.groups[g].name + ": " + node_name(model_.groups[g].nodes[n]);
  }

  void check_priorities() {
    for (std::size_t g = 0; g < plan_.groups.size(); ++g) {
      const int priority = plan_.groups[g].priority;
      if (priority < 1 || priority > 99) {
        add(plan_.groups[g].name + ": priority " + std::to_string(priority) + "; expected 1 to 99");
      }
      for (std::size_t other = 0; other < g; ++other) {
        if (plan_.groups[other].priority != priority) continue;
        add(plan_.groups[other].name + " and " + plan_.groups[g].name + ": both have priority " +
            std::to_string(priority) + "; expected one each");
      }
      check_lowest(g);
    }
  }

  void check_lowest(std::size_t g) {
    if (!model_.groups[g].resumable) return;
    for (std::size_t other = 0; other < plan_.groups.size(); ++other) {
      const int limit = plan_.groups[other].priority;
      if (model_.groups[other].resumable || plan_.groups[g].priority < limit) continue;
      add(plan_.groups[g].name + ": priority " + std::to_string(plan_.groups[g].priority) +
          "; expected below " + std::to_string(limit) + ", that of " + plan_.groups[other].name +
          ": sliced work has the lowest priority");
    }
  }

  // Every node occurs once, on an existing core, with at least its bound as time.
  bool check_allocation(std::size_t g) {
    allocation_.assign(model_.groups[g].nodes.size(), nullptr);
    const std::size_t faults_before = faults_.size();
    for (const PlannedNode& node : plan_.nodes) {
      if (node.group != static_cast<int>(g)) continue;
      if (node.node < 0 || node.node >= static_cast<int>(allocation_.size())) {
        add(model_.groups[g].name + ": node " + std::to_string(node.node) + "; expected 0 to " +
            std::to_string(allocation_.size() - 1));
        continue;
      }
      const auto n = static_cast<std::size_t>(node.node);
      if (allocation_[n] != nullptr) add(name(g, n) + " occurs twice; expected once");
      allocation_[n] = &node;
      if (node.core < 0 || node.core >= plan_.cores) {
        add(name(g, n) + ": core " + std::to_string(node.core) + "; expected 0 to " +
            std::to_string(plan_.cores - 1));
      }
      const std::int64_t allotted_ns = node.end_ns - node.start_ns;
      if (node.start_ns < 0 || allotted_ns < model_.groups[g].nodes[n].bound_ns) {
        add(name(g, n) + ": has " + ns(allotted_ns) + "; expected at least its bound, " +
            ns(model_.groups[g].nodes[n].bound_ns));
      }
    }
    for (std::size_t n = 0; n < allocation_.size(); ++n) {
      if (allocation_[n] == nullptr) add(name(g, n) + " is missing; expected every node once");
    }
    return faults_.size() == faults_before;
  }

  void check_precedence(std::size_t g) {
    for (std::size_t n = 0; n < allocation_.size(); ++n) {
      for (const int before : model_.groups[g].nodes[n].after) {
        const PlannedNode& from = *allocation_[static_cast<std::size_t>(before)];
        const std::int64_t available_ns =
            from.end_ns +
            (from.core == allocation_[n]->core ? 0 : model_.system.inter_core_delay_ns);
        if (allocation_[n]->start_ns >= available_ns) continue;
        add(name(g, n) + ": starts at " + ns(allocation_[n]->start_ns) + "; expected at least " +
            ns(available_ns) + ", when the output of " +
            model_.groups[g].nodes[static_cast<std::size_t>(before)].name + " is ready");
      }
    }
  }

  void check_overlap(std::size_t g) {
    for (std::size_t a = 0; a < allocation_.size(); ++a) {
      for (std::size_t b = a + 1; b < allocation_.size(); ++b) {
        if (allocation_[a]->core != allocation_[b]->core) continue;
        if (allocation_[a]->start_ns >= allocation_[b]->end_ns ||
            allocation_[b]->start_ns >= allocation_[a]->end_ns) {
          continue;
        }
        add(name(g, a) + " and " + name(g, b) + " overlap on core " +
            std::to_string(allocation_[a]->core) + "; expected one after the other");
      }
    }
  }

  void check_one_core(std::size_t g) {
    if (!model_.groups[g].resumable) return;
    for (std::size_t n = 1; n < allocation_.size(); ++n) {
      if (allocation_[n]->core == allocation_[0]->core) continue;
      add(name(g, n) + ": core " + std::to_string(allocation_[n]->core) + "; expected " +
          std::to_string(allocation_[0]->core) + ", as " + model_.groups[g].nodes[0].name +
          ": sliced work has one thread");
    }
  }

  // An activation must end before the next release: each edge has one buffer only.
  void check_capacity() {
    for (int core = 0; core < plan_.cores; ++core) {
      double load = 0;
      for (const PlannedNode& node : plan_.nodes) {
        if (node.core != core) continue;
        const TaskGroup& group = model_.groups[static_cast<std::size_t>(node.group)];
        load += double(node.end_ns - node.start_ns) /
                double(std::max<std::int64_t>(group.min_gap_ns, 1));
      }
      if (load <= 1) continue;
      add("core " + std::to_string(core) + ": used " + std::to_string(int(100 * load)) +
          " % of the time; expected at most 100 %");
    }
    if (!faults_.empty()) return;
    const std::vector<GroupResponse> responses = group_responses(model_, plan_);
    for (std::size_t g = 0; g < responses.size(); ++g) {
      const std::int64_t gap = model_.groups[g].min_gap_ns;
      const auto& response = responses[g].response_ns;
      if (response && *response <= gap) continue;
      add(responses[g].name + ": an activation may take " +
          (response ? ns(*response) : "without bound") + " and the next may come after " + ns(gap) +
          "; every edge has one buffer: expected at most " + ns(gap));
    }
  }

  const Plan& plan_;
  const TaskModel& model_;
  std::vector<const PlannedNode*> allocation_;
  std::vector<std::string> faults_;
};

}  // namespace

std::vector<std::string> check_plan(const Plan& plan, const TaskModel& model) {
  return Checker(plan, model).run();
}

}  // namespace glint
