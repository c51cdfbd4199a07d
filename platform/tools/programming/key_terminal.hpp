// Puts a terminal into raw key mode, without echo, for the lifetime of the object.
//
// Restores the terminal's settings in the destructor and when a signal without another handler ends
// the program. Ctrl-C still interrupts. Ctrl-Z does nothing: a real-time run cannot pause.
#pragma once

namespace glint {

class KeyTerminal {
 public:
  // At most one object at a time. Throws InputError if `descriptor` is no terminal; the message
  // names it as `name`.
  KeyTerminal(int descriptor, const char* name);
  ~KeyTerminal();
  KeyTerminal(const KeyTerminal&) = delete;
  KeyTerminal& operator=(const KeyTerminal&) = delete;

  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace glint
