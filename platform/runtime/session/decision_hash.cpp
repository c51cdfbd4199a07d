#include "platform/runtime/session/decision_hash.hpp"

#include <array>
#include <span>

#include "kernels/wire/bits.hpp"

namespace glint {

bool DecisionHash::add_verdict(std::uint64_t sequence, const Estimates& estimates) {
  std::array<std::uint8_t, 5> verdict{};
  put_little_endian(std::span(verdict).first(4), sequence);
  verdict[4] = static_cast<std::uint8_t>(estimates.verdict.reason);
  verdicts_.add(verdict);
  bool seen = false;
  for (int t = 0; t < estimates.tool_count; ++t) {
    const Track& track = estimates.tracks[static_cast<std::size_t>(t)];
    seen = seen || track.measured_now;
    verdicts_.add(std::array<std::uint8_t, 3>{static_cast<std::uint8_t>(track.measured_now),
                                              static_cast<std::uint8_t>(track.reason),
                                              track.marker_mask});
  }
  return seen;
}

void DecisionHash::add_states(std::uint64_t tick, const PoseSamples& samples) {
  for (int t = 0; t < samples.count; ++t) {
    const PoseSample& sample = samples.items[static_cast<std::size_t>(t)];
    std::array<std::uint8_t, 10> state{};
    put_little_endian(std::span(state).first(4), tick);
    put_little_endian(std::span(state).subspan(4, 4), sample.frame_sequence);
    state[8] = static_cast<std::uint8_t>(sample.state);
    state[9] = static_cast<std::uint8_t>(sample.reason);
    states_.add(state);
  }
}

void DecisionHash::add_overruns(Sha256& hash, const OverrunCounts& counts,
                                const graph::OverrunDecision& last) {
  std::array<std::uint8_t, 18> decided{};
  put_little_endian(std::span(decided).first(8), counts.will_miss);
  put_little_endian(std::span(decided).subspan(8, 8), counts.missed);
  decided[16] = static_cast<std::uint8_t>(last.policy);
  decided[17] = last.after_node;
  hash.add(decided);
}

std::string DecisionHash::hex() const {
  Sha256 both;
  both.add(verdicts_.digest());
  both.add(states_.digest());
  return both.hex();
}

}  // namespace glint
