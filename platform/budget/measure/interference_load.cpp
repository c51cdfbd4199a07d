#include "platform/budget/measure/interference_load.hpp"

#include <sched.h>
#include <time.h>

#include <cstdint>
#include <vector>

namespace glint {
namespace {

constexpr std::size_t k_cache_bytes = 4u << 20;    // larger than a core's private caches
constexpr std::size_t k_stream_bytes = 64u << 20;  // larger than a usual share of a shared cache
constexpr long k_interrupt_gap_ns = 100'000;

void thrash(const std::atomic<bool>& stop) {
  std::vector<std::uint64_t> buffer(k_cache_bytes / sizeof(std::uint64_t), 1);
  std::uint64_t state = 1;
  while (!stop.load(std::memory_order_relaxed)) {
    for (int i = 0; i < 4096; ++i) {
      state = state * 6364136223846793005u + 1442695040888963407u;  // Knuth's MMIX generator
      buffer[(state >> 33) % buffer.size()] += state;
    }
  }
}

void stream(const std::atomic<bool>& stop) {
  std::vector<std::uint64_t> buffer(k_stream_bytes / sizeof(std::uint64_t), 1);
  while (!stop.load(std::memory_order_relaxed)) {
    for (std::uint64_t& word : buffer) word += 1;
  }
}

void compute(const std::atomic<bool>& stop) {
  volatile std::uint64_t sink = 1;
  while (!stop.load(std::memory_order_relaxed)) {
    for (int i = 0; i < 4096; ++i) sink = sink * 3 + 1;
  }
}

void wake_up_often(const std::atomic<bool>& stop) {
  const timespec gap{0, k_interrupt_gap_ns};
  while (!stop.load(std::memory_order_relaxed)) clock_nanosleep(CLOCK_MONOTONIC, 0, &gap, nullptr);
}

}  // namespace

void stay_on_core(int core) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(static_cast<unsigned>(core), &cores);
  (void)sched_setaffinity(0, sizeof cores, &cores);  // if refused, the measurement is noisier
}

InterferenceLoad::InterferenceLoad(const std::string& name) {
  if (name == "none") return;
  thread_ = std::thread([this, name] {
    const bool same = name == "interrupts" || std::thread::hardware_concurrency() < 2;
    stay_on_core(same ? k_measured_core : k_measured_core + 1);
    if (name == "cache") thrash(stop_);
    if (name == "bandwidth") stream(stop_);
    if (name == "other_core") compute(stop_);
    if (name == "interrupts") wake_up_often(stop_);
  });
}

InterferenceLoad::~InterferenceLoad() {
  stop_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) thread_.join();
}

}  // namespace glint
