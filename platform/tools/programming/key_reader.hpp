// Thread that reads a terminal's keys and publishes them as button events.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "kernels/units.hpp"
#include "platform/tools/programming/key_buttons.hpp"

namespace glint {

class KeyReader {
 public:
  // descriptor: of a KeyTerminal. `now`: clock that stamps a key when it is read. The reading
  // thread calls both functions.
  KeyReader(int descriptor, std::function<Time()> now, KeyButtons::OnButton on_button);
  ~KeyReader();  // stops the thread
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
