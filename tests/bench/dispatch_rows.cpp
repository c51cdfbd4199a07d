#include "dispatch_rows.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "platform/runtime/rt/processor_name.hpp"

namespace glint::bench {
namespace {

double nanoseconds_of(const std::function<void()>& run) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  run();
  return std::chrono::duration<double, std::nano>(Clock::now() - begin).count();
}

}  // namespace

double DispatchRow::at(double part) const {
  const double rank = std::ceil(part * static_cast<double>(ns.size()));
  return ns[static_cast<std::size_t>(std::clamp(rank, 1.0, static_cast<double>(ns.size()))) - 1];
}

void measure_in_turn(std::vector<DispatchRow>& rows, int rounds) {
  const int warm_up = rounds / 20;
  for (DispatchRow& row : rows) row.ns.reserve(static_cast<std::size_t>(rounds));
  for (int round = -warm_up; round < rounds; ++round) {
    for (DispatchRow& row : rows) {
      const double ns = nanoseconds_of(row.run) / row.nodes;
      if (round >= 0) row.ns.push_back(ns);
    }
  }
  for (DispatchRow& row : rows) std::sort(row.ns.begin(), row.ns.end());
}

void print_rows(const std::vector<DispatchRow>& rows) {
  std::printf("%-44s %9s %9s %9s %9s %9s\n", "ns a node, mean of a batch", "n", "nodes", "p50",
              "p99.9", "max");
  for (const DispatchRow& row : rows) {
    std::printf("%-44s %9zu %9d %9.2f %9.2f %9.2f\n", row.name.c_str(), row.ns.size(), row.nodes,
                row.p50(), row.at(0.999), row.ns.back());
  }
}

bool print_bar(const char* what, double found, const char* unit, double bar, bool at_most) {
  const bool met = at_most ? found <= bar : found >= bar;
  std::printf("  %-52s %9.2f %-2s  bar: at %s %g %s   %s\n", what, found, unit,
              at_most ? "most" : "least", bar, unit, met ? "met" : "MISSED");
  return met;
}

void print_machine() {
  utsname system{};
  uname(&system);
  std::printf("%s, %s %s, compiler %s, flags %s\n", processor_name().c_str(), system.sysname,
              system.release, __VERSION__, GLINT_BENCH_FLAGS);
}

}  // namespace glint::bench
