#include "platform/runtime/rt/memory_lock.hpp"

#include <linux/capability.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace glint {
namespace {

bool may_lock_without_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY) return true;
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3]{};
  if (syscall(SYS_capget, &header, data) != 0) return false;
  return (data[0].effective & (1u << CAP_IPC_LOCK)) != 0;
}

}  // namespace

MemoryLock lock_memory() {
  if (!may_lock_without_limit()) {
    return {false, "RLIMIT_MEMLOCK is limited and the process lacks CAP_IPC_LOCK"};
  }
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    return {false, "mlockall: " + std::generic_category().message(errno)};
  }
  return {true, {}};
}

}  // namespace glint
