// Rows measured in turn, a batch each a round, so that whatever slows the machine slows all.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace glint::bench {

struct DispatchRow {
  std::string name;
  int nodes = 0;              // that one batch runs
  std::function<void()> run;  // one batch
  std::vector<double> ns{};   // a node, one entry a round; ascending once measured
  [[nodiscard]] double p50() const { return at(0.5); }
  [[nodiscard]] double at(double part) const;  // nearest rank
};

void measure_in_turn(std::vector<DispatchRow>& rows, int rounds);
void print_rows(const std::vector<DispatchRow>& rows);

// Prints one line; true if the bar is met.
[[nodiscard]] bool print_bar(const char* what, double found, const char* unit, double bar,
                             bool at_most);

// Processor, kernel, compiler and flags of this run.
void print_machine();

}  // namespace glint::bench
