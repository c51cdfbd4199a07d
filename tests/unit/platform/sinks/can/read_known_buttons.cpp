// print_button_events LOG IDENTIFIER: prints one line for each change of a button in a candump log:
// the button (0 draw, 1 delete_last, 2 undo, 3 finish) and whether it is held.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "platform/sinks/can/button_frames.hpp"
#include "platform/sinks/can/candump_line.hpp"

int main(int count, char** arguments) {
  using namespace glint;
  if (count != 3) return 2;
  ButtonFrames frames(static_cast<std::uint32_t>(std::strtoul(arguments[2], nullptr, 0)),
                      [](const ButtonEvent& event) {
                        std::printf("%d %d\n", static_cast<int>(event.button), event.pressed);
                      });
  std::ifstream log(arguments[1]);
  for (std::string line; std::getline(log, line);) {
    const auto record = parse_candump(line);
    frames.receive(record ? std::optional(record->frame) : std::nullopt, {});
  }
  return frames.counts().refused == 0 ? 0 : 1;
}
