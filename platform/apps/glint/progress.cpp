#include "platform/apps/glint/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "platform/printable.hpp"

namespace glint {
namespace {

long long now_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

Progress::Progress(std::string what) : what_(std::move(what)), on_terminal_(isatty(2) == 1) {}

Progress::~Progress() { clear(); }

void Progress::clear() {
  if (shown_) std::fprintf(stderr, "\r\033[K");
  std::fflush(stderr);
  shown_ = false;
}

void Progress::show(double done, double all, const std::string& note) {
  if (!on_terminal_ || now_ms() - last_shown_ms_ < 100) return;
  last_shown_ms_ = now_ms();
  shown_ = true;
  if (all > 0) {
    std::fprintf(stderr, "\r\033[K%s %3.0f %%  %s", what_.c_str(),
                 100.0 * std::clamp(done / all, 0.0, 1.0), printable(note).c_str());
  } else {
    std::fprintf(stderr, "\r\033[K%s %.1f s  %s", what_.c_str(), done, printable(note).c_str());
  }
  std::fflush(stderr);
}

}  // namespace glint
