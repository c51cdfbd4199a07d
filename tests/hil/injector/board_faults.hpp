// Faults of the board itself: Glint's process, the CAN interface, the clock, the processor's load.
#pragma once

#include <sys/types.h>

#include <string>

#include "tests/hil/injector/script.hpp"

namespace glint::hil {

class BoardFaults {
 public:
  // `name`: of the files of Glint's figures, NAME.json and NAME.2.json for a second start.
  BoardFaults(std::string interface, std::string name);
  ~BoardFaults() { end_glint(); }
  BoardFaults(const BoardFaults&) = delete;
  BoardFaults& operator=(const BoardFaults&) = delete;

  // From one thread. Returns false for a command of another target.
  bool apply(const Command& command);
  // Glint ends by SIGTERM; its exit status, or 128 + the signal. -1: none runs.
  int end_glint();

 private:
  void start_glint(const std::string& cell, bool records);
  void kill_glint();
  void send_bus_off() const;

  std::string interface_, name_;
  int starts_ = 0;
  pid_t glint_ = -1;
};

}  // namespace glint::hil
