#include "platform/runtime/rt/machine_check.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

namespace glint {
namespace {

// Capabilities by their number in linux/capability.h.
constexpr int k_cap_ipc_lock = 14;
constexpr int k_cap_sys_nice = 23;
// Largest accepted exit latency of an idle state: the run time of a tick's node.
constexpr long k_idle_exit_us = 10;
constexpr int k_cores_max = 1024;

using Path = std::filesystem::path;

std::optional<std::string> line_of(const Path& file) {
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line)) return std::nullopt;
  return line;
}

// "0-1,4" as the kernel writes sets of cores.
std::set<int> cores_of(const std::string& list) {
  std::set<int> cores;
  std::stringstream parts(list);
  for (std::string part; std::getline(parts, part, ',');) {
    int first = 0, last = 0;
    const int fields = std::sscanf(part.c_str(), "%d-%d", &first, &last);
    if (fields < 1) continue;
    if (fields == 1) last = first;
    for (int core = first; core <= std::min(last, k_cores_max); ++core) cores.insert(core);
  }
  return cores;
}

class Check {
 public:
  Check(const std::vector<int>& cores, Path root) : root_(std::move(root)) {
    cores_.insert(cores.begin(), cores.end());
    cores_.erase(-1);
  }

  MachineCheck run() {
    found_.preempt_rt = line_of(root_ / "sys/kernel/realtime").value_or("0") == "1";
    if (!found_.preempt_rt) {
      add("kernel without PREEMPT_RT: wake-ups may be late; boot a PREEMPT_RT kernel (Debian: "
          "linux-image-rt)");
    }
    throttling();
    rights();
    if (cores_.empty()) {
      add("threads are not pinned: they may migrate; set a plan (--plan)");
    }
    governors();
    idle_states();
    interrupts();
    return found_;
  }

 private:
  void add(const std::string& line) { found_.timing_faults.push_back(line); }

  void throttling() {
    const auto runtime = line_of(root_ / "proc/sys/kernel/sched_rt_runtime_us");
    if (!runtime || *runtime == "-1") return;
    const std::string period =
        line_of(root_ / "proc/sys/kernel/sched_rt_period_us").value_or("1000000");
    add("RT throttling: real-time threads stop after " + *runtime + " of every " + period +
        " us; run sysctl -w kernel.sched_rt_runtime_us=-1");
  }

  void rights() {
    std::uint64_t capabilities = 0;
    std::ifstream status(root_ / "proc/self/status");
    for (std::string line; std::getline(status, line);) {
      if (line.rfind("CapEff:", 0) == 0) {
        std::istringstream(line.substr(7)) >> std::hex >> capabilities;
      }
    }
    std::ifstream limits(root_ / "proc/self/limits");
    for (std::string line; std::getline(limits, line);) {
      const auto soft_limit = [&](const std::string& name) -> std::optional<std::string> {
        if (line.rfind(name, 0) != 0) return std::nullopt;
        std::string value;
        std::istringstream(line.substr(name.size())) >> value;
        return value;
      };
      const auto priority = soft_limit("Max realtime priority");
      if (priority && *priority == "0" && (capabilities >> k_cap_sys_nice & 1u) == 0) {
        add("no permission for SCHED_FIFO (RLIMIT_RTPRIO 0): any process may delay the run; set "
            "rtprio 90 in /etc/security/limits.conf, or CAP_SYS_NICE");
      }
      const auto locked = soft_limit("Max locked memory");
      if (locked && *locked != "unlimited" && (capabilities >> k_cap_ipc_lock & 1u) == 0) {
        add("memory cannot be locked (RLIMIT_MEMLOCK " + *locked +
            "): page faults may occur during the run; set memlock unlimited in "
            "/etc/security/limits.conf, or CAP_IPC_LOCK");
      }
    }
  }

  // The cores to check: the pinned ones, or all.
  [[nodiscard]] std::set<int> cores() const {
    if (!cores_.empty()) return cores_;
    return cores_of(line_of(root_ / "sys/devices/system/cpu/online").value_or("0"));
  }
  [[nodiscard]] Path folder_of(int core) const {
    return root_ / "sys/devices/system/cpu" / ("cpu" + std::to_string(core));
  }

  void governors() {
    for (const int core : cores()) {
      const auto governor = line_of(folder_of(core) / "cpufreq/scaling_governor");
      if (!governor || *governor == "performance") continue;
      add("core " + std::to_string(core) + " has the governor \"" + *governor +
          "\": its clock may be low at a frame; run cpupower frequency-set -g performance");
    }
  }

  void idle_states() {
    for (const int core : cores()) {
      long slowest_us = 0;
      for (int state = 0; state < 16; ++state) {
        const Path folder = folder_of(core) / "cpuidle" / ("state" + std::to_string(state));
        const auto exit_us = line_of(folder / "latency");
        if (!exit_us) break;
        if (line_of(folder / "disable").value_or("0") == "1") continue;
        slowest_us = std::max(slowest_us, std::strtol(exit_us->c_str(), nullptr, 10));
      }
      if (slowest_us <= k_idle_exit_us) continue;
      add("core " + std::to_string(core) + " may enter an idle state with a wake-up time of " +
          std::to_string(slowest_us) + " us; run cpupower idle-set -D " +
          std::to_string(k_idle_exit_us));
    }
  }

  void interrupts() {
    if (cores_.empty()) return;
    std::error_code error;
    int served = 0;
    for (const auto& entry : std::filesystem::directory_iterator(root_ / "proc/irq", error)) {
      const auto list = line_of(entry.path() / "effective_affinity_list");
      if (!list) continue;
      const std::set<int> theirs = cores_of(*list);
      served +=
          std::any_of(cores_.begin(), cores_.end(), [&](int c) { return theirs.count(c) > 0; }) ? 1
                                                                                                : 0;
    }
    if (served == 0) return;
    add(std::to_string(served) +
        " interrupts run on the cores of the plan; write the other cores to "
        "/proc/irq/*/smp_affinity_list, or boot with isolcpus and irqaffinity");
  }

  Path root_;
  std::set<int> cores_;
  MachineCheck found_;
};

}  // namespace

MachineCheck check_machine(const std::vector<int>& cores, const std::string& root) {
  return Check(cores, root).run();
}

}  // namespace glint
