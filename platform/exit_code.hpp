// Exit codes of the project's programs: 0 done, 1 failed, 2 bad use or input, 3 missing device. A
// body that completes returns its own code. Errors are printed to standard error.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/nearest_name.hpp"

namespace glint {

// Innermost subcommand of the command line: its full name and its CLI11 object.
struct SelectedCommand {
  std::string path;
  const CLI::App* app;
};
[[nodiscard]] inline SelectedCommand selected_command(const CLI::App& app, const char* program) {
  SelectedCommand given{program, &app};
  while (!given.app->get_subcommands().empty()) {
    given.app = given.app->get_subcommands().front();
    given.path += " " + given.app->get_name();
  }
  return given;
}

// Returns a message for the first word that CLI11 could not parse, with the nearest valid name; ""
// if every word was parsed.
[[nodiscard]] inline std::string unknown_word_text(const CLI::App& app, const CLI::App& command) {
  const std::vector<std::string> left_over = app.remaining(true);
  if (left_over.empty()) return "";
  const std::string word = left_over.front().substr(0, left_over.front().find('='));
  const bool is_option = word.starts_with('-');
  const auto commands = command.get_subcommands([](const CLI::App*) { return true; });
  std::vector<std::string> known;
  std::string list;
  if (is_option) {
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    }
  } else {
    for (const CLI::App* one : commands) {
      known.push_back(one->get_name());
      list += (list.empty() ? "; expected one of " : ", ") + one->get_name();
    }
  }
  const char* kind = is_option ? "option" : commands.empty() ? "argument" : "command";
  return std::string("unknown ") + kind + " " + word + nearest_name_text(word, known) + list;
}

// Rejects what CLI11 would convert: it wraps a negative number into an unsigned one and clamps one
// that is too large. Of all integer options, of the subcommands too.
inline void check_integers(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    const bool is_unsigned = option->get_type_name().starts_with("UINT");
    if (!is_unsigned && !option->get_type_name().starts_with("INT")) continue;
    option->check([is_unsigned](const std::string& text) -> std::string {
      errno = 0;
      if (is_unsigned) {
        (void)std::strtoull(text.c_str(), nullptr, 0);
      } else {
        (void)std::strtoll(text.c_str(), nullptr, 0);
      }
      const bool is_negative = text.find('-') != std::string::npos;
      if (errno != ERANGE && !(is_unsigned && is_negative)) return "";
      return text + (is_unsigned ? ": expected a whole number from 0 to 2^64 - 1"
                                 : ": expected a whole number of at most 63 bits");
    });
  }
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    check_integers(*command);
}

// Call before any file is opened. Opens closed standard streams on /dev/null; else the first file
// opened would get such a stream's descriptor and receive the printed table. Ignores SIGXFSZ, so
// that a write beyond the file size limit returns an error.
inline void prepare_file_descriptors() {
  for (int stream = 0; stream <= 2; ++stream) {
    if (fcntl(stream, F_GETFD) != -1) continue;
    const int null = open("/dev/null", stream == 0 ? O_RDONLY : O_WRONLY);
    if (null >= 0 && null != stream) {
      (void)dup2(null, stream);
      (void)close(null);
    }
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

// body() parses by `app`, does the work and returns the program's own exit code.
template <class Body>
[[nodiscard]] int exit_code_of(CLI::App& app, const char* program, const Body& body) {
  const auto fails = [&](const std::exception& error, int code) {
    std::fprintf(stderr, "%s: %s\n", program, one_line(error.what()).c_str());
    return code;
  };
  prepare_file_descriptors();
  check_integers(app);
  try {
    const int code = body();
    // Fails if the output is incomplete, as on a full disk.
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
    std::fprintf(stderr, "%s: standard output: written incompletely\n", program);
    return std::max(code, 1);
  } catch (const CLI::ParseError& error) {
    // A request for help is success; any other parse error is bad use, whatever CLI11's code.
    if (error.get_exit_code() == 0) return app.exit(error);
    const SelectedCommand given = selected_command(app, program);
    std::string wrong = unknown_word_text(app, *given.app);
    if (wrong.empty()) wrong = error.what();
    std::fprintf(stderr, "%s: %s; see %s --help\n", given.path.c_str(), one_line(wrong).c_str(),
                 given.path.c_str());
    return 2;
  } catch (const InputError& error) {
    return fails(error, 2);
  } catch (const MissingDevice& error) {
    return fails(error, 3);
  } catch (const std::bad_alloc&) {
    return fails(std::runtime_error("not enough memory"), 1);
  } catch (const std::exception& error) {
    return fails(error, 1);
  }
}

}  // namespace glint
