// A terminal that hands over each key as it is pressed, and does not show it, for as long as this
// lives.
//
// Afterwards it is as it was: at the end, and where a signal that nobody handles ends the program.
// Ctrl-C goes on to interrupt; Ctrl-Z does nothing, for a run in real time cannot rest.
#pragma once

namespace glint {

class KeyTerminal {
 public:
  // One at a time. Throws InputError where `descriptor` is no terminal; `name` says what it is.
  KeyTerminal(int descriptor, const char* name);
  ~KeyTerminal();
  KeyTerminal(const KeyTerminal&) = delete;
  KeyTerminal& operator=(const KeyTerminal&) = delete;

  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace glint
