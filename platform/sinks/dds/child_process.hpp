// Child process that runs a program beside this one.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "kernels/units.hpp"

namespace glint {

class ChildProcess {
 public:
  // Starts arguments[0], a program in this program's folder, in a process group of its own: Ctrl-C
  // does not end it. SIGTERM is blocked until the child handles it. `descriptor`, if not negative,
  // becomes `as_descriptor` there. Throws MissingDevice.
  explicit ChildProcess(std::vector<std::string> arguments, int descriptor = -1,
                        int as_descriptor = -1);
  ~ChildProcess();  // kills it if it still runs
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Returns whether the process ended within the limit; zero: does not wait.
  [[nodiscard]] bool wait(Duration limit);
  void send(int signal) const;
  void kill();  // and waits for its end

  [[nodiscard]] pid_t id() const { return id_; }  // negative: it ended
  // After its end.
  [[nodiscard]] bool succeeded() const;
  [[nodiscard]] std::string how_it_ended() const;

 private:
  pid_t id_ = -1;
  int status_ = 0;
};

}  // namespace glint
