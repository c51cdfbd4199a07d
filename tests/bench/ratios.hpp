// Ratios of the benchmark's rows, measured in turn so that a slow machine slows all alike.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace glint::bench {

struct Row {
  std::string name;
  std::function<void()> run;  // one frame
  double median_us = 0;       // CPU time of a frame
};

// Runs each row on `frames` frames, `rounds` times in turn, and sets median_us.
void measure_in_turn(std::vector<Row>& rows, int rounds, int frames);

// Measures both sensors, prints the table of times and ratios; returns true if every limit is met.
[[nodiscard]] bool print_ratios();

}  // namespace glint::bench
