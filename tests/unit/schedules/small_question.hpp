// A small schedule to assess: two groups on one core and two CAN frames.
#pragma once

#include "random_groups.hpp"
#include "schedules/assessment.hpp"
#include "schedules/synthesis.hpp"

namespace glint::test {

inline constexpr std::int64_t k_us = 1'000, k_ms = 1'000'000;

// A frame group of 100 us and a tick group of 50 us on one core, one CAN frame a tick.
inline AnalysisInput small_input() {
  AnalysisInput input;
  TaskGroup frame = staged_group({{"Find", 1, 60 * k_us}, {"Fit", 1, 40 * k_us}});
  frame.min_gap_ns = frame.deadline_ns = 20 * k_ms;
  frame.jitter_ns = 400 * k_us;
  TaskGroup tick = staged_group({{"Predict", 1, 20 * k_us}, {"Pack", 1, 30 * k_us}});
  tick.name = "tick";
  tick.min_gap_ns = tick.deadline_ns = 4 * k_ms;
  tick.can_writes = 2;
  input.model.groups = {frame, tick};
  input.model.system = {20 * k_us, 2 * k_us, 1 * k_ms, 5 * k_us, 0};
  input.plan = synthesize(input.model);
  input.sensor = {2 * k_ms, 8 * k_ms};
  CanMessage own;
  own.name = "pose";
  own.identifier = 0x1A0;
  own.period_ns = own.deadline_ns = 4 * k_ms;
  own.node = k_own_can_node;
  own.fifo = true;
  CanMessage foreign = own;
  foreign.name = "drive";
  foreign.identifier = 0x100;
  foreign.period_ns = foreign.deadline_ns = 10 * k_ms;
  foreign.node = 1;
  foreign.fifo = false;
  input.frames = {own, foreign};
  input.rates = {.nominal = 1e6};
  input.frame_to_can_deadline_ns = 10 * k_ms;
  input.age_deadline_ns = 250 * k_ms;
  return input;
}

}  // namespace glint::test
