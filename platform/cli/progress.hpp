// One line that moves, on a terminal; silence elsewhere.
#pragma once

#include <string>

namespace glint {

class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // At most ten times a second; `done` of `all` (all 0: unknown), never more than all of it.
  void show(double done, double all, const std::string& note = {});
  // Takes the line away: before anything else is printed.
  void clear();

 private:
  std::string what_;
  bool on_terminal_;
  long long last_shown_ms_ = -1000;
  bool shown_ = false;
};

}  // namespace glint
