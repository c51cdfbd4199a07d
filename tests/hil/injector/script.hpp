// Commands of a scenario: what an injector does, and when. README.md lists them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::hil {

enum class Target { camera, bus, controller, interface, clock, load, glint, power };

struct Command {
  std::int64_t at_ms = 0;  // from the scenario's start
  Target target = Target::camera;
  std::string verb;                         // of `target`
  std::array<std::int64_t, 2> number = {};  // of a verb with numbers
  std::string text;                         // of a verb with a file
};

// Of "TARGET VERB [ARGUMENT..]"; empty, with the reason in `error`, for any other text.
[[nodiscard]] std::optional<Command> command_of(std::string_view text, std::string& error);

struct Script {
  std::int64_t cycle_us = 4000;   // of the controller
  std::int64_t speed_max = 2000;  // of the tip, mm/s
  std::int64_t ends_ms = 0;
  std::vector<Command> commands;  // in the order of time
};

// Lines "cycle_us N", "speed_max N", "ends_ms N" and "MS COMMAND". Ends the program with a line
// that names the place for any other.
[[nodiscard]] Script load_script(const std::string& file);

}  // namespace glint::hil
