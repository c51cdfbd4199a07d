#include "schedules/can_response.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "schedules/response_time.hpp"

namespace glint {
namespace {

std::int64_t frame_ns_of(const CanMessage& message, const CanBitRates& rates) {
  if (message.frame_ns > 0) return message.frame_ns;
  return static_cast<std::int64_t>(std::ceil(worst_case_seconds(message.shape, rates) * 1e9));
}

class Bus {
 public:
  Bus(const std::vector<CanMessage>& messages, const CanBitRates& rates)
      : messages_(messages),
        bit_ns_(static_cast<std::int64_t>(std::ceil(1e9 / rates.nominal))),
        results_(messages.size()) {
    for (std::size_t m = 0; m < messages.size(); ++m) {
      results_[m].frame_ns = frame_ns_of(messages[m], rates);
      priorities_.push_back(arbitration_priority(messages[m]));
    }
  }

  std::vector<CanResponse> run() {
    for (int round = 0; round < k_can_rounds_max; ++round) {
      bool grew = false;
      for (std::size_t m = 0; m < messages_.size(); ++m) {
        const std::int64_t queued_before = results_[m].queued_ns;
        if (messages_[m].fifo) {
          analyse_fifo_queue(m);
        } else {
          analyse_priority_queue(m);
        }
        if (!results_[m].response_ns) return unbounded();
        grew = grew || results_[m].queued_ns > queued_before;
      }
      if (!grew) return results_;
    }
    return unbounded();
  }

 private:
  // If one response is unbounded, all are: its queueing delay is jitter to the others.
  std::vector<CanResponse> unbounded() {
    for (CanResponse& result : results_) result.response_ns.reset();
    return results_;
  }

  [[nodiscard]] bool same_queue(std::size_t a, std::size_t b) const {
    return messages_[a].fifo && messages_[b].fifo && messages_[a].node == messages_[b].node;
  }

  // Frames of a priority of at least `level`, without `but_not` and the frames of its queue.
  [[nodiscard]] std::vector<Interference> higher_priority(std::uint64_t level, std::size_t but_not,
                                                          std::int64_t early_ns) const {
    std::vector<Interference> higher;
    for (std::size_t k = 0; k < messages_.size(); ++k) {
      // Two nodes may use the same identifier, against the rules; either may win.
      if (k == but_not || priorities_[k] < level || same_queue(k, but_not)) continue;
      higher.push_back({results_[k].frame_ns, messages_[k].period_ns,
                        messages_[k].jitter_ns + results_[k].queued_ns + early_ns});
    }
    return higher;
  }

  [[nodiscard]] std::int64_t blocking(std::uint64_t level, std::size_t of) const {
    std::int64_t longest = 0;
    for (std::size_t k = 0; k < messages_.size(); ++k) {
      if (k == of || priorities_[k] >= level || same_queue(k, of)) continue;
      longest = std::max(longest, results_[k].frame_ns);
    }
    return longest;
  }

  void analyse_priority_queue(std::size_t m) {
    const CanMessage& own = messages_[m];
    CanResponse& result = results_[m];
    const std::int64_t frame = result.frame_ns;
    const std::int64_t block = blocking(priorities_[m], m);
    // Eq. (10): level-m busy period.
    std::vector<Interference> all = higher_priority(priorities_[m], m, 0);
    all.push_back({frame, own.period_ns, own.jitter_ns});
    const auto busy = busy_window(block, all, k_busy_period_max_ns, frame, steps_left_);
    if (!busy) return result.response_ns.reset();
    const std::int64_t last = detail::ceil_of_quotient(*busy + own.jitter_ns, own.period_ns);
    // Eq. (11): a frame queued up to one bit time after the bus became idle still takes part.
    const std::vector<Interference> higher = higher_priority(priorities_[m], m, bit_ns_);
    std::int64_t window = 0, worst = 0;
    for (std::int64_t q = 0; q < last; ++q) {
      const auto begin =
          busy_window(block + q * frame, higher, k_busy_period_max_ns, window, steps_left_);
      if (!begin) return result.response_ns.reset();
      window = *begin;
      worst = std::max(worst, own.jitter_ns + window - q * own.period_ns + frame);
    }
    result.response_ns = worst;
  }

  void analyse_fifo_queue(std::size_t m) {
    CanResponse& result = results_[m];
    std::uint64_t level = priorities_[m];
    std::vector<std::size_t> queue;
    for (std::size_t k = 0; k < messages_.size(); ++k) {
      if (!same_queue(k, m)) continue;
      queue.push_back(k);
      level = std::min(level, priorities_[k]);
    }
    const std::int64_t block = blocking(level, m);
    const std::vector<Interference> higher = higher_priority(level, m, bit_ns_);
    std::vector<Interference> all = higher_priority(level, m, 0);
    for (const std::size_t k : queue) {
      all.push_back({results_[k].frame_ns, messages_[k].period_ns, messages_[k].jitter_ns});
    }
    const auto busy = busy_window(block, all, k_busy_period_max_ns, result.frame_ns, steps_left_);
    if (!busy) return result.response_ns.reset();

    std::int64_t worst = 0, waited = 0;
    for (const std::int64_t arrival : arrivals(queue, *busy)) {
      std::int64_t ahead = 0;
      for (const std::size_t k : queue) {
        const std::int64_t came = (arrival + messages_[k].jitter_ns) / messages_[k].period_ns + 1;
        ahead += came * results_[k].frame_ns;
      }
      const auto begin = busy_window(block + ahead - result.frame_ns, higher, k_busy_period_max_ns,
                                     0, steps_left_);
      if (!begin) return result.response_ns.reset();
      waited = std::max(waited, *begin - arrival);
      worst = std::max(worst, messages_[m].jitter_ns + *begin - arrival + result.frame_ns);
    }
    result.response_ns = worst;
    result.queued_ns = std::max(result.queued_ns, waited);
  }

  // Times in a busy period at which the queue may grow; between them a later frame waits less.
  [[nodiscard]] std::set<std::int64_t> arrivals(const std::vector<std::size_t>& queue,
                                                std::int64_t busy) const {
    std::set<std::int64_t> moments{0};
    for (const std::size_t k : queue) {
      const CanMessage& message = messages_[k];
      for (std::int64_t n = 1;; ++n) {
        const std::int64_t moment = n * message.period_ns - message.jitter_ns;
        if (moment >= busy) break;
        if (moment > 0) moments.insert(moment);
      }
    }
    return moments;
  }

  const std::vector<CanMessage>& messages_;
  std::int64_t bit_ns_;
  std::vector<CanResponse> results_;
  std::vector<std::uint64_t> priorities_;
  int steps_left_ = k_can_steps_max;
};

}  // namespace

std::uint64_t arbitration_priority(const CanMessage& message) {
  constexpr std::uint32_t k_low_bits = 18;
  const bool extended = message.shape.extended;
  const std::uint64_t base = extended ? message.identifier >> k_low_bits : message.identifier;
  const std::uint64_t rest = extended ? message.identifier & ((1U << k_low_bits) - 1) : 0;
  return ~(base << (k_low_bits + 1) | std::uint64_t{extended} << k_low_bits | rest);
}

double load_of(const std::vector<CanMessage>& messages, const CanBitRates& rates) {
  double load = 0;
  for (const CanMessage& message : messages) {
    load += static_cast<double>(frame_ns_of(message, rates)) / double(message.period_ns);
  }
  return load;
}

std::vector<CanResponse> can_responses(const std::vector<CanMessage>& messages,
                                       const CanBitRates& rates) {
  // Above full load no fixed point converges.
  if (load_of(messages, rates) > 1) {
    std::vector<CanResponse> none(messages.size());
    for (std::size_t m = 0; m < none.size(); ++m)
      none[m].frame_ns = frame_ns_of(messages[m], rates);
    return none;
  }
  return Bus(messages, rates).run();
}

}  // namespace glint
