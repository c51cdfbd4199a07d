// Runs one group's activations by its static schedule and detects deadline overruns.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "graph/graph.hpp"
#include "graph/overrun.hpp"
#include "platform/runtime/rt/planned_executor.hpp"
#include "platform/runtime/rt/trace_writer.hpp"
#include "platform/runtime/session/node_probe.hpp"

namespace glint {

struct WatchSettings {
  bool on = false;
  Duration deadline;  // from the nominal release
  graph::OverrunPolicy policy = graph::OverrunPolicy::predict;
  std::vector<std::int64_t> remaining_ns;  // by node: from its end to the group's, worst case
};

template <class G>
struct RunnerSettings {
  graph::ScheduleTables<G> plan = graph::default_schedule<G>(1);
  std::vector<ThreadSettings>
      worker_threads;  // one for each worker of the schedule beyond the first
  WatchSettings watch;
  std::vector<Injection> injections;
  std::vector<std::int64_t> bounds_ns;  // by node, for the trace; empty: no board file
  std::uint8_t group = 0;
  bool live = true;
  TraceWriter* trace = nullptr;  // not yet started
};

// Start of an activation.
struct ActivationStart {
  std::uint64_t activation = 0;
  std::uint64_t at = 0;  // the frame's sequence number, or the tick's
  Time nominal, now;     // session clock: planned release, actual start
  std::uint64_t frame_sequence = 0;
};

struct OverrunCounts {
  std::uint64_t will_miss = 0, missed = 0;
  std::array<std::uint64_t, 4> by_policy{};
  std::uint64_t not_enabled = 0;  // activations replaced by a person's missing release
  [[nodiscard]] std::uint64_t total() const { return will_miss + missed; }
};

template <class G>
class GroupRunner {
 public:
  // Spins of a worker with a core and real-time rights before it sleeps: some milliseconds.
  static constexpr std::uint32_t k_spins_max = 100'000;

  explicit GroupRunner(RunnerSettings<G> settings = {})
      : settings_(std::move(settings)), clock_(settings_.live) {
    const auto workers = static_cast<std::size_t>(settings_.plan.workers);
    if (settings_.trace != nullptr) {
      for (std::size_t w = 0; w < workers; ++w) {
        traces_.push_back(std::make_unique<NodeTrace>(settings_.trace->add_ring(), settings_.group,
                                                      static_cast<std::uint8_t>(w),
                                                      settings_.bounds_ns));
      }
    }
    for (std::size_t w = 0; w < workers; ++w) {
      probes_.emplace_back(clock_, settings_.injections,
                           traces_.empty() ? nullptr : traces_[w].get());
    }
    if (workers > 1) {
      executor_ = std::make_unique<PlannedExecutor<G>>(settings_.plan, settings_.worker_threads,
                                                       k_spins_max);
    }
  }

  GroupRunner(const GroupRunner&) = delete;  // its probes point into it
  GroupRunner& operator=(const GroupRunner&) = delete;

  // Returns the overrun decision of this activation; {}: it was in time. Call finish_activation()
  // after it.
  [[nodiscard]] graph::OverrunDecision run(G& graph, const ActivationStart& start) noexcept {
    ran_on_all_workers_ = true;
    if (!settings_.watch.on && traces_.empty() && settings_.injections.empty()) {
      run_plain(graph);
      return {};
    }
    begin(start);
    const Duration deadline = settings_.watch.on ? settings_.watch.deadline : k_never;
    graph::DeadlineWatch<ElapsedClock> watch(clock_, deadline.nanoseconds,
                                             settings_.watch.remaining_ns, settings_.watch.policy);
    const int last = executor_ != nullptr
                         ? executor_->execute(graph, std::span<NodeProbe>(probes_), watch)
                         : graph.activate_until(probes_[0], watch);
    graph::OverrunDecision decision = watch.decision();
    if (decision.happened()) {
      decision.after_node = static_cast<std::uint8_t>(last);
      count(decision);
      last_overrun_ = decision;
    }
    if (NodeTrace* const trace = probes_[0].trace()) {
      if (decision.happened()) {
        trace->set_flag(decision.kind == graph::OverrunKind::missed ? k_span_overran
                                                                    : k_span_will_miss);
      }
      trace->end_activation();
    }
    return decision;
  }

  // An activation whose decision is known ends after node `last`; -1: runs no node. In a replay:
  // the recorded decision. Call finish_activation() after it.
  graph::OverrunDecision run_as(G& graph, graph::OverrunDecision recorded, int last) noexcept {
    ran_on_all_workers_ = !recorded.happened();
    if (ran_on_all_workers_) {
      run_plain(graph);
      return recorded;
    }
    count(last_overrun_ = recorded);
    if (last < 0) return last_overrun_;
    recorded.after_node = static_cast<std::uint8_t>(last);
    graph::NoTrace trace;
    graph::RecordedBoundary boundary(recorded);
    (void)graph.activate_until(trace, boundary);
    return last_overrun_;
  }

  // Call after the output has left. Waits until no worker is inside the graph.
  void finish_activation(G& graph) noexcept {
    if (executor_ == nullptr || !ran_on_all_workers_) return;
    executor_->finish_activation(graph);
    for (std::size_t w = 1; w < traces_.size(); ++w) traces_[w]->end_activation();
  }

  // Traces the group's work outside its nodes. Times by the session's clock.
  void add_span(TraceFlag kind, Time begin, Time end) noexcept {
    if (!traces_.empty()) traces_[0]->add(kind, begin.nanoseconds, end.nanoseconds);
  }

  [[nodiscard]] const OverrunCounts& overruns() const noexcept { return counts_; }
  // The newest overrun; {}: none yet.
  [[nodiscard]] const graph::OverrunDecision& last_overrun() const noexcept {
    return last_overrun_;
  }
  [[nodiscard]] std::uint64_t overlong_waits() const noexcept {
    return executor_ == nullptr ? 0 : executor_->overruns();
  }
  [[nodiscard]] std::vector<ThreadReport> reports() const {
    return executor_ == nullptr ? std::vector<ThreadReport>{} : executor_->reports();
  }

 private:
  static constexpr Duration k_never{std::numeric_limits<std::int64_t>::max() / 2};

  void run_plain(G& graph) noexcept {
    if (executor_ == nullptr) {
      graph.activate();
      return;
    }
    std::array<graph::NoTrace, graph::k_plan_workers_max> none;
    graph::NoBoundary always;
    (void)executor_->execute(graph, std::span<graph::NoTrace>(none), always);
  }

  void begin(const ActivationStart& start) noexcept {
    const std::uint64_t cycles = cycle_count();
    clock_.begin(start.now - start.nominal, cycles);
    for (NodeProbe& probe : probes_) probe.begin(start.at);
    for (auto& trace : traces_) {
      trace->begin_activation(start.activation, start.frame_sequence, start.now.nanoseconds,
                              cycles);
    }
    add_span(k_span_release, start.nominal, start.now);
  }

  void count(const graph::OverrunDecision& decision) noexcept {
    if (decision.kind == graph::OverrunKind::not_enabled) {
      ++counts_.not_enabled;
      return;
    }
    ++(decision.kind == graph::OverrunKind::missed ? counts_.missed : counts_.will_miss);
    ++counts_.by_policy[static_cast<std::size_t>(decision.policy)];
  }

  RunnerSettings<G> settings_;
  ElapsedClock clock_;
  std::vector<std::unique_ptr<NodeTrace>> traces_;
  std::vector<NodeProbe> probes_;
  std::unique_ptr<PlannedExecutor<G>> executor_;
  bool ran_on_all_workers_ = true;  // whether the last activation ran on all workers
  OverrunCounts counts_;
  graph::OverrunDecision last_overrun_;
};

}  // namespace glint
