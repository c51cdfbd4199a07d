// Reads a terminal's keys by a thread of its own and hands them on as buttons.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "kernels/units.hpp"
#include "platform/programming/key_buttons.hpp"

namespace glint {

class KeyReader {
 public:
  // Of a KeyTerminal's descriptor. `now` stamps a key as it is read, which is at once; both are
  // called from the reading thread.
  KeyReader(int descriptor, std::function<Time()> now, KeyButtons::OnButton on_button);
  ~KeyReader();  // ends the thread
  KeyReader(const KeyReader&) = delete;
  KeyReader& operator=(const KeyReader&) = delete;

 private:
  void read_once();

  int descriptor_;
  std::function<Time()> now_;
  KeyButtons buttons_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace glint
