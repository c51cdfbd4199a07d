#include "schedules/exact_schedule.hpp"

#include <algorithm>
#include <numeric>

#include "schedules/makespan_bound.hpp"
#include "schedules/static_order.hpp"

namespace glint {
namespace {

class Search {
 public:
  Search(const TaskGroup& group, int cores, std::int64_t inter_core_delay_ns)
      : group_(group),
        cores_(cores),
        inter_core_delay_(inter_core_delay_ns),
        tail_(tails_of(group, reach_of(group), cores, inter_core_delay_ns)),
        interchangeable_before_(group.nodes.size(), -1),
        core_of_(group.nodes.size(), -1),
        end_(group.nodes.size(), 0),
        earliest_(group.nodes.size(), 0),
        free_at_(static_cast<std::size_t>(cores), 0),
        orders_(static_cast<std::size_t>(cores)) {
    find_interchangeable();
    for (const TaskNode& node : group.nodes) work_left_ += node.bound_ns;
  }

  [[nodiscard]] std::int64_t lower_bound() const {
    std::int64_t bound = (work_left_ + cores_ - 1) / cores_;
    for (const std::int64_t tail : tail_) bound = std::max(bound, tail);
    return bound;
  }

  void propose(const CoreOrders& orders) {
    const std::int64_t makespan = times_of(group_, orders, inter_core_delay_)->makespan_ns;
    if (best_.orders.empty() || makespan < best_.makespan_ns) {
      best_.orders = orders;
      best_.orders.resize(static_cast<std::size_t>(cores_));
      best_.makespan_ns = makespan;
    }
  }

  ExactSchedule run(std::int64_t nodes_max) {
    nodes_max_ = nodes_max;
    best_.makespan_lower_bound_ns = lower_bound();
    if (best_.makespan_ns > best_.makespan_lower_bound_ns) extend(0, 0, 0);
    // Below the limit every sequence was searched or pruned.
    best_.optimal =
        best_.searched < nodes_max_ || best_.makespan_ns == best_.makespan_lower_bound_ns;
    if (best_.optimal) best_.makespan_lower_bound_ns = best_.makespan_ns;
    return best_;
  }

 private:
  // Interchangeable copies (equal bound, predecessors and readers): only one order is searched.
  // interchangeable_before_[n] must be placed before n.
  void find_interchangeable() {
    const std::size_t count = group_.nodes.size();
    const auto readers = [&](std::size_t n) {
      std::vector<std::size_t> found;
      for (std::size_t r = 0; r < count; ++r) {
        const auto& after = group_.nodes[r].after;
        if (std::find(after.begin(), after.end(), static_cast<int>(n)) != after.end()) {
          found.push_back(r);
        }
      }
      return found;
    };
    for (std::size_t n = 0; n < count; ++n) {
      for (std::size_t other = n; other-- > 0 && interchangeable_before_[n] < 0;) {
        if (group_.nodes[n].bound_ns != group_.nodes[other].bound_ns) continue;
        auto own_after = group_.nodes[n].after, other_after = group_.nodes[other].after;
        std::sort(own_after.begin(), own_after.end());
        std::sort(other_after.begin(), other_after.end());
        if (own_after == other_after && readers(n) == readers(other)) {
          interchangeable_before_[n] = static_cast<int>(other);
        }
      }
    }
  }

  [[nodiscard]] bool ready(std::size_t n) const {
    if (core_of_[n] >= 0) return false;
    if (interchangeable_before_[n] >= 0 &&
        core_of_[static_cast<std::size_t>(interchangeable_before_[n])] < 0)
      return false;
    return std::all_of(group_.nodes[n].after.begin(), group_.nodes[n].after.end(),
                       [&](int b) { return core_of_[static_cast<std::size_t>(b)] >= 0; });
  }

  [[nodiscard]] std::int64_t start_on(std::size_t n, std::size_t core) const {
    std::int64_t start = free_at_[core];
    for (const int before : group_.nodes[n].after) {
      const auto b = static_cast<std::size_t>(before);
      start = std::max(start,
                       end_[b] + (core_of_[b] == static_cast<int>(core) ? 0 : inter_core_delay_));
    }
    return start;
  }

  // Lower bound on the makespan of any completion of the partial sequence.
  std::int64_t completion_bound(std::int64_t last_start, std::int64_t longest_end) {
    std::int64_t bound = longest_end, busy = work_left_;
    const std::int64_t first_free =
        std::max(last_start, *std::min_element(free_at_.begin(), free_at_.end()));
    for (const std::int64_t free : free_at_) busy += std::max(free, last_start);
    bound = std::max(bound, (busy + cores_ - 1) / cores_);
    for (std::size_t n = 0; n < group_.nodes.size(); ++n) {
      if (core_of_[n] >= 0) continue;
      earliest_[n] = first_free;
      for (const int before : group_.nodes[n].after) {
        const auto b = static_cast<std::size_t>(before);
        const std::int64_t done =
            core_of_[b] >= 0 ? end_[b] : earliest_[b] + group_.nodes[b].bound_ns;
        earliest_[n] = std::max(earliest_[n], done);
      }
      bound = std::max(bound, earliest_[n] + tail_[n]);
    }
    return bound;
  }

  void extend(std::size_t placed, std::int64_t last_start, std::int64_t longest_end) {
    if (best_.searched >= nodes_max_ || best_.makespan_ns == best_.makespan_lower_bound_ns) return;
    ++best_.searched;
    if (placed == group_.nodes.size()) {
      if (longest_end < best_.makespan_ns) {
        best_.makespan_ns = longest_end;
        best_.orders = orders_;
      }
      return;
    }
    if (completion_bound(last_start, longest_end) >= best_.makespan_ns) return;

    std::vector<std::size_t> candidates;
    for (std::size_t n = 0; n < group_.nodes.size(); ++n) {
      if (ready(n)) candidates.push_back(n);
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [&](std::size_t a, std::size_t b) { return tail_[a] > tail_[b]; });
    for (const std::size_t n : candidates) {
      bool untouched_tried = false;
      for (std::size_t core = 0; core < free_at_.size(); ++core) {
        if (orders_[core].empty()) {
          if (untouched_tried) continue;
          untouched_tried = true;
        }
        const std::int64_t start = start_on(n, core);
        if (start < last_start) continue;  // another sequence yields this schedule
        place(n, core, start, placed, longest_end);
      }
    }
  }

  void place(std::size_t n, std::size_t core, std::int64_t start, std::size_t placed,
             std::int64_t longest_end) {
    const std::int64_t free_before = free_at_[core];
    end_[n] = free_at_[core] = start + group_.nodes[n].bound_ns;
    core_of_[n] = static_cast<int>(core);
    orders_[core].push_back(static_cast<int>(n));
    work_left_ -= group_.nodes[n].bound_ns;
    extend(placed + 1, start, std::max(longest_end, end_[n]));
    work_left_ += group_.nodes[n].bound_ns;
    orders_[core].pop_back();
    core_of_[n] = -1;
    free_at_[core] = free_before;
  }

  const TaskGroup& group_;
  int cores_;
  std::int64_t inter_core_delay_, nodes_max_ = 0;
  std::vector<std::int64_t> tail_;
  std::vector<int> interchangeable_before_, core_of_;
  std::vector<std::int64_t> end_, earliest_, free_at_;
  CoreOrders orders_;
  std::int64_t work_left_ = 0;
  ExactSchedule best_;
};

}  // namespace

std::int64_t makespan_lower_bound(const TaskGroup& group, int cores,
                                  std::int64_t inter_core_delay_ns) {
  return Search(group, cores, inter_core_delay_ns).lower_bound();
}

ExactSchedule exact_schedule(const TaskGroup& group, int cores, std::int64_t inter_core_delay_ns,
                             std::int64_t search_nodes_max) {
  Search search(group, cores, inter_core_delay_ns);
  search.propose(list_schedule(group, cores, inter_core_delay_ns));
  search.propose(list_schedule(group, 1, inter_core_delay_ns));
  return search.run(search_nodes_max);
}

}  // namespace glint
