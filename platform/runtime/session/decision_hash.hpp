// SHA-256 of a run's decisions: every frame's verdict, every tick's states and every overrun. Two
// runs of the same frames on different machines differ in their times, not in this hash.
#pragma once

#include <cstdint>
#include <string>

#include "nodes/tokens.hpp"
#include "platform/runtime/session/group_runner.hpp"
#include "platform/sinks/record/sha256.hpp"

namespace glint {

class DecisionHash {
 public:
  // Call on the frame thread after each frame. Returns whether a tool was seen in it.
  template <class G>
  bool add(std::uint64_t sequence, const Estimates& estimates, const GroupRunner<G>& runner) {
    const bool seen = add_verdict(sequence, estimates);
    add_overruns(verdicts_, runner.overruns(), runner.last_overrun());
    return seen;
  }
  // Call on the tick thread after each tick.
  template <class G>
  void add(std::uint64_t tick, const PoseSamples& samples, const GroupRunner<G>& runner) {
    add_states(tick, samples);
    add_overruns(states_, runner.overruns(), runner.last_overrun());
  }
  // Lower-case hex. Call after both threads have ended.
  [[nodiscard]] std::string hex() const;

 private:
  bool add_verdict(std::uint64_t sequence, const Estimates& estimates);
  void add_states(std::uint64_t tick, const PoseSamples& samples);
  // Adds the overrun counts by kind, and the policy and node of the last overrun.
  static void add_overruns(Sha256& hash, const OverrunCounts& counts,
                           const graph::OverrunDecision& last);

  Sha256 verdicts_, states_;  // each written by one thread
};

}  // namespace glint
