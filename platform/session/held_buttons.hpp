// Which of the pen's buttons are held, for the tick group: each change is a version of its own.
//
// A tick sees the newest version and no other. A button that goes down and up between two ticks,
// as those by key but draw do, therefore shows in none: what leaves says what is held, and who
// counts clicks has the events (rt/glint/button, /glint/button in a recording).
#pragma once

#include <cstdint>

#include "graph/latest.hpp"
#include "nodes/tokens.hpp"
#include "platform/record/button_event.hpp"
#include "platform/record/recorder.hpp"

namespace glint {

class HeldButtons {
 public:
  // One thread at a time. Whoever spoke last of a button counts. `lane` may be null.
  void take(const ButtonEvent& event, RecorderLane* lane) noexcept;

  [[nodiscard]] graph::TripleBuffer<PenButtons>& published() noexcept { return published_; }

 private:
  PenButtons now_;
  std::uint64_t version_ = 0;  // the first is "none was ever held"
  graph::TripleBuffer<PenButtons> published_;
};

}  // namespace glint
