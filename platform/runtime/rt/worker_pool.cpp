#include "platform/runtime/rt/worker_pool.hpp"

#include "platform/runtime/rt/allocation_counter.hpp"

namespace glint {

WorkerPool::WorkerPool(const std::vector<ThreadSettings>& settings) {
  for (const ThreadSettings& one : settings) {
    const int worker = static_cast<int>(threads_.size()) + 1;
    releases_.push_back(std::make_unique<Release>());
    Release* const release = releases_.back().get();
    threads_.push_back(std::make_unique<RealTimeThread>(
        one, [this, release, worker] { wait_and_work(*release, worker); }));
  }
}

void WorkerPool::stop() noexcept {
  stop_.store(true);
  for (auto& release : releases_) release->post();
  for (auto& thread : threads_) thread->join();
}

void WorkerPool::release(Job job, void* context) noexcept {
  job_ = job;
  context_ = context;
  for (auto& release : releases_) release->post();
}

std::vector<ThreadReport> WorkerPool::reports() const {
  std::vector<ThreadReport> reports;
  reports.reserve(threads_.size());
  for (const auto& thread : threads_) reports.push_back(thread->report());
  return reports;
}

void WorkerPool::wait_and_work(Release& release, int worker) noexcept {
  AllocationCounter::arm();
  for (release.wait(); !stop_.load(); release.wait()) job_(context_, worker);
  AllocationCounter::disarm();
}

}  // namespace glint
