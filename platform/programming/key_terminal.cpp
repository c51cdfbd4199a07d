#include "platform/programming/key_terminal.hpp"

#include <termios.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "platform/input_error.hpp"

namespace glint {
namespace {

// What ends a program by default.
constexpr int k_ending_signals[] = {SIGHUP,  SIGINT, SIGQUIT, SIGTERM, SIGABRT,
                                    SIGSEGV, SIGBUS, SIGFPE,  SIGILL};

// For the handler, which is told nothing but the signal.
int g_terminal = -1;
termios g_before{};

// Only calls that POSIX allows in a handler. What was typed for the run is not left to the shell.
void restore() {
  ::tcflush(g_terminal, TCIFLUSH);
  ::tcsetattr(g_terminal, TCSANOW, &g_before);
}

void restore_and_end(int signal) {
  restore();
  ::raise(signal);  // its default is back, and it is taken once this returns
}

}  // namespace

KeyTerminal::KeyTerminal(int descriptor, const char* name) : descriptor_(descriptor) {
  if (::isatty(descriptor) == 0 || ::tcgetattr(descriptor, &g_before) != 0)
    throw InputError(std::string(name) + " is no terminal; expected one whose keys are buttons");
  g_terminal = descriptor;
  struct sigaction end {};
  end.sa_handler = restore_and_end;
  end.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : k_ending_signals) {
    struct sigaction now {};
    ::sigaction(signal, nullptr, &now);
    if (now.sa_handler == SIG_DFL) ::sigaction(signal, &end, nullptr);
  }
  termios keys = g_before;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  keys.c_cc[VMIN] = 1;
  keys.c_cc[VTIME] = 0;
  keys.c_cc[VSUSP] = _POSIX_VDISABLE;
  ::tcsetattr(descriptor, TCSANOW, &keys);
}

KeyTerminal::~KeyTerminal() {
  restore();
  for (const int signal : k_ending_signals) {
    struct sigaction now {};
    ::sigaction(signal, nullptr, &now);
    if (now.sa_handler == restore_and_end) std::signal(signal, SIG_DFL);
  }
}

}  // namespace glint
