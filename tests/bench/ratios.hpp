// The comparison that counts: rows measured in turn, so that whatever slows the machine slows all.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace glint::bench {

struct Row {
  std::string name;
  std::function<void()> run;  // one frame
  double median_us = 0;       // processor time of a frame
};

// rounds times: each row on `frames` frames. Fills median_us.
void measure_in_turn(std::vector<Row>& rows, int rounds, int frames);

// Measures both sensors, prints the table of times and ratios; true if every bar is met.
[[nodiscard]] bool print_ratios();

}  // namespace glint::bench
