// Rows measured in turn, one batch per round, so that a slow machine slows all rows alike.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace glint::bench {

struct DispatchRow {
  std::string name;
  int nodes = 0;              // nodes in one batch
  std::function<void()> run;  // one batch
  std::vector<double> ns{};   // ns per node, one entry per round; ascending once measured
  [[nodiscard]] double p50() const { return at(0.5); }
  [[nodiscard]] double at(double part) const;  // nearest rank
};

void measure_in_turn(std::vector<DispatchRow>& rows, int rounds);
void print_rows(const std::vector<DispatchRow>& rows);

// Prints one line; returns true if the limit is met.
[[nodiscard]] bool print_bar(const char* what, double found, const char* unit, double bar,
                             bool at_most);

// Prints processor, kernel, compiler and flags of this run.
void print_machine();

}  // namespace glint::bench
