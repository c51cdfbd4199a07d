#include "platform/runtime/rt/real_time_thread.hpp"

#include <pthread.h>
#include <sched.h>

#include <system_error>
#include <utility>

#include "platform/runtime/rt/release.hpp"

namespace glint {
namespace {

void add_refusal(std::string& refused, const std::string& what, int error) {
  if (!refused.empty()) refused += "; ";
  refused += what + ": " + std::generic_category().message(error);
}

}  // namespace

ThreadReport apply_settings(const ThreadSettings& settings) {
  constexpr std::size_t k_name_max = 15;  // pthread_setname_np(3): 16 with the closing zero
  ThreadReport report;
  report.name = settings.name;
  const pthread_t self = pthread_self();
  if (!settings.name.empty()) pthread_setname_np(self, settings.name.substr(0, k_name_max).c_str());
  if (settings.core >= 0) {
    cpu_set_t cores;
    CPU_ZERO(&cores);
    if (settings.core < CPU_SETSIZE) CPU_SET(static_cast<unsigned>(settings.core), &cores);
    const int error = pthread_setaffinity_np(self, sizeof cores, &cores);
    report.pinned = error == 0;
    if (error != 0) add_refusal(report.refused, "core " + std::to_string(settings.core), error);
  }
  if (settings.priority > 0) {
    sched_param parameter{};
    parameter.sched_priority = settings.priority;
    const int error = pthread_setschedparam(self, SCHED_FIFO, &parameter);
    report.real_time = error == 0;
    if (error != 0) {
      add_refusal(report.refused, "SCHED_FIFO " + std::to_string(settings.priority), error);
      const sched_param none{};
      const bool idle =
          settings.idle_if_refused && pthread_setschedparam(self, SCHED_IDLE, &none) == 0;
      if (idle) report.refused += " (SCHED_IDLE instead)";
    }
  }
  return report;
}

RealTimeThread::RealTimeThread(const ThreadSettings& settings, std::function<void()> body) {
  Release reported;
  thread_ = std::thread([this, &settings, &reported, run = std::move(body)] {
    report_ = apply_settings(settings);
    reported.post();  // from here on the captured references are invalid
    run();
  });
  reported.wait();
}

void RealTimeThread::join() {
  if (thread_.joinable()) thread_.join();
}

}  // namespace glint
