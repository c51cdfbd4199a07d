// Reading keys from a pseudoterminal.
#include "platform/tools/programming/key_terminal.hpp"

#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <string_view>
#include <thread>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/tools/programming/key_reader.hpp"

namespace glint {
namespace {

// The two ends of a pseudoterminal: the user's and the program's.
class PseudoTerminal {
 public:
  PseudoTerminal() { EXPECT_EQ(::openpty(&user_, &program_, nullptr, nullptr, nullptr), 0); }
  ~PseudoTerminal() {
    ::close(user_);
    ::close(program_);
  }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  [[nodiscard]] int program() const { return program_; }
  [[nodiscard]] termios mode() const {
    termios mode{};
    EXPECT_EQ(::tcgetattr(program_, &mode), 0);
    return mode;
  }
  void type(std::string_view keys) const {
    EXPECT_EQ(::write(user_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }

 private:
  int user_ = -1, program_ = -1;
};

bool is_as(const termios& mode, const termios& other) {
  return mode.c_lflag == other.c_lflag && mode.c_iflag == other.c_iflag &&
         mode.c_oflag == other.c_oflag && std::memcmp(mode.c_cc, other.c_cc, NCCS) == 0;
}

TEST(KeyTerminal, GivesEachKeyAtOnceAndIsAfterwardsAsItWas) {
  const PseudoTerminal terminal;
  const termios before = terminal.mode();
  {
    const KeyTerminal keys(terminal.program(), "here");
    const termios mode = terminal.mode();
    EXPECT_EQ(mode.c_lflag & tcflag_t{ICANON | ECHO}, 0u);
    EXPECT_NE(mode.c_lflag & tcflag_t{ISIG}, 0u);
    EXPECT_EQ(mode.c_cc[VSUSP], _POSIX_VDISABLE);
  }
  EXPECT_TRUE(is_as(terminal.mode(), before));
}

TEST(KeyTerminal, IsAsItWasWhereASignalEndsTheProgram) {
  for (const int signal : {SIGHUP, SIGTERM, SIGINT}) {
    const PseudoTerminal terminal;
    const termios before = terminal.mode();
    const pid_t child = ::fork();
    if (child == 0) {
      std::signal(signal, SIG_DFL);  // the parent process may ignore it
      const KeyTerminal keys(terminal.program(), "here");
      if (is_as(terminal.mode(), before)) ::_exit(1);
      ::raise(signal);
      ::_exit(2);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << signal << ' ' << status;
    EXPECT_TRUE(is_as(terminal.mode(), before)) << signal;
  }
}

// Existing signal handlers stay in place, and the default ones are restored afterwards.
TEST(KeyTerminal, LeavesSignalsToTheirHandlers) {
  const PseudoTerminal terminal;
  const auto handler_of = [](int signal) {
    struct sigaction now {};
    ::sigaction(signal, nullptr, &now);
    return now.sa_handler;
  };
  const auto before = std::signal(SIGTERM, SIG_IGN);
  const auto hang_up = std::signal(SIGHUP, SIG_DFL);
  {
    const KeyTerminal keys(terminal.program(), "here");
    EXPECT_EQ(handler_of(SIGTERM), SIG_IGN);
    EXPECT_NE(handler_of(SIGHUP), SIG_DFL);
  }
  EXPECT_EQ(handler_of(SIGHUP), SIG_DFL);
  std::signal(SIGHUP, hang_up);
  std::signal(SIGTERM, before);
}

TEST(KeyTerminal, RefusesWhatIsNoTerminal) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  try {
    const KeyTerminal keys(ends[0], "standard input");
    ADD_FAILURE() << "taken";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "standard input is not a terminal; expected a terminal for --keys");
  }
  ::close(ends[0]);
  ::close(ends[1]);
}

Time seconds_in(std::int64_t seconds) { return Time{} + milliseconds(1000 * seconds); }

TEST(KeyReader, HandsKeysOnWithTheTimeAtWhichTheyAreRead) {
  const PseudoTerminal terminal;
  const KeyTerminal keys(terminal.program(), "here");
  std::mutex mutex;
  std::vector<ButtonEvent> events;
  std::atomic<std::int64_t> second{0};
  const auto count = [&] {
    const std::lock_guard lock(mutex);
    return events.size();
  };
  const auto wait_for = [&](std::size_t wanted) {
    for (int waited = 0; count() < wanted && waited < 5'000; ++waited) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return count() == wanted;
  };
  {
    const KeyReader reader(
        terminal.program(), [&] { return seconds_in(second); },
        [&](const ButtonEvent& event) {
          const std::lock_guard lock(mutex);
          events.push_back(event);
        });
    terminal.type(" ");
    ASSERT_TRUE(wait_for(1));
    second = 2;
    terminal.type("x ");
    ASSERT_TRUE(wait_for(2));
    second = 3;
    terminal.type("f");
    ASSERT_TRUE(wait_for(4));
  }
  terminal.type("u");  // no reader any more
  const std::vector<ButtonEvent> expected{{seconds_in(0), Button::draw, true},
                                          {seconds_in(2), Button::draw, false},
                                          {seconds_in(3), Button::finish, true},
                                          {seconds_in(3), Button::finish, false}};
  EXPECT_EQ(events, expected);
}

}  // namespace
}  // namespace glint
