#include "platform/tools/programming/key_terminal.hpp"

#include <termios.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "platform/input_error.hpp"

namespace glint {
namespace {

// Signals that end a program by default.
constexpr int k_ending_signals[] = {SIGHUP,  SIGINT, SIGQUIT, SIGTERM, SIGABRT,
                                    SIGSEGV, SIGBUS, SIGFPE,  SIGILL};

// Global, since a signal handler receives only the signal number.
int g_terminal = -1;
termios g_saved_settings{};

// Calls only async-signal-safe functions. Flushes the input, so that unread keys do not reach the
// shell.
void restore() {
  ::tcflush(g_terminal, TCIFLUSH);
  ::tcsetattr(g_terminal, TCSANOW, &g_saved_settings);
}

void restore_and_end(int signal) {
  restore();
  ::raise(signal);  // default action, by SA_RESETHAND; delivered after return
}

}  // namespace

KeyTerminal::KeyTerminal(int descriptor, const char* name) : descriptor_(descriptor) {
  if (::isatty(descriptor) == 0 || ::tcgetattr(descriptor, &g_saved_settings) != 0)
    throw InputError(std::string(name) + " is not a terminal; expected a terminal for --keys");
  g_terminal = descriptor;
  struct sigaction end {};
  end.sa_handler = restore_and_end;
  end.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : k_ending_signals) {
    struct sigaction now {};
    ::sigaction(signal, nullptr, &now);
    if (now.sa_handler == SIG_DFL) ::sigaction(signal, &end, nullptr);
  }
  termios keys = g_saved_settings;
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
