#include "tests/hil/injector/script.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>

namespace glint::hil {
namespace {

struct Verb {
  std::string_view target, verb;
  Target kind;
  int numbers;
  bool has_text;
};
constexpr Verb k_verbs[] = {
    {"camera", "every", Target::camera, 1, false},
    {"camera", "go", Target::camera, 0, false},
    {"camera", "freeze", Target::camera, 0, false},
    {"camera", "drop", Target::camera, 1, false},
    {"camera", "repeat", Target::camera, 1, false},
    {"camera", "hide", Target::camera, 1, false},
    {"camera", "bias", Target::camera, 1, false},
    {"camera", "delay", Target::camera, 1, false},
    {"camera", "worst", Target::camera, 1, false},
    {"bus", "drop", Target::bus, 1, false},
    {"bus", "freeze", Target::bus, 1, false},
    {"bus", "repeat", Target::bus, 1, false},
    {"bus", "delay", Target::bus, 1, false},
    {"bus", "flip", Target::bus, 1, false},
    {"bus", "off", Target::bus, 1, false},
    {"bus", "load", Target::bus, 1, false},
    {"controller", "enable", Target::controller, 0, false},
    {"controller", "restart", Target::controller, 1, false},
    {"interface", "up", Target::interface, 0, false},
    {"interface", "down", Target::interface, 0, false},
    {"interface", "slow", Target::interface, 1, false},
    {"clock", "step", Target::clock, 1, false},
    {"load", "run", Target::load, 2, false},
    {"glint", "start", Target::glint, 0, true},
    {"glint", "record", Target::glint, 0, true},
    {"glint", "hang", Target::glint, 0, false},
    {"glint", "continue", Target::glint, 0, false},
    {"glint", "kill", Target::glint, 0, false},
    {"power", "off", Target::power, 0, false},
};

[[noreturn]] void refuse(const std::string& file, int line, const std::string& what) {
  std::cerr << file << ":" << line << ": " << what << "\n";
  std::exit(2);
}

}  // namespace

std::optional<Command> command_of(std::string_view text, std::string& error) {
  std::istringstream words{std::string(text)};
  std::string target;
  Command command;
  words >> target >> command.verb;
  const auto* const verb = std::find_if(std::begin(k_verbs), std::end(k_verbs), [&](const Verb& v) {
    return v.target == target && v.verb == command.verb;
  });
  if (verb == std::end(k_verbs)) {
    error = "unknown command \"" + std::string(text) + "\"; expected one of README.md";
    return {};
  }
  command.target = verb->kind;
  for (int i = 0; i < verb->numbers; ++i) words >> command.number[static_cast<std::size_t>(i)];
  if (verb->has_text) words >> command.text;
  std::string rest;
  if (words.fail() || words >> rest) {
    error = "expected " + std::to_string(verb->numbers) + " numbers" +
            (verb->has_text ? " and a file" : "");
    return {};
  }
  return command;
}

Script load_script(const std::string& file) {
  std::ifstream lines(file);
  if (!lines) refuse(file, 0, "cannot be read");
  Script script;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    std::int64_t* const setting = first == "cycle_us"    ? &script.cycle_us
                                  : first == "speed_max" ? &script.speed_max
                                  : first == "ends_ms"   ? &script.ends_ms
                                                         : nullptr;
    if (setting != nullptr) {
      if (!(words >> *setting)) refuse(file, number, "expected a number");
      continue;
    }
    std::string rest, error;
    std::getline(words >> std::ws, rest);
    std::optional<Command> command = command_of(rest, error);
    if (!command) refuse(file, number, error);
    command->at_ms = std::atoll(first.c_str());
    if (!script.commands.empty() && command->at_ms < script.commands.back().at_ms) {
      refuse(file, number, "earlier than the line before; expected the order of time");
    }
    script.commands.push_back(*command);
  }
  return script;
}

}  // namespace glint::hil
