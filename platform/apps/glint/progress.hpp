// Progress line on a terminal; no output elsewhere.
#pragma once

#include <string>

namespace glint {

class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Prints at most ten times a second; `done` of `all` (all 0: unknown), at most 100 %.
  void show(double done, double all, const std::string& note = {});
  // Erases the line; call before other output.
  void clear();

 private:
  std::string what_;
  bool on_terminal_;
  long long last_shown_ms_ = -1000;
  bool shown_ = false;
};

}  // namespace glint
