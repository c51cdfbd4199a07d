"""A new CAN message changes two files: the table of messages and the node that sends it.

The script adds a message to copies of both. Then the frame is sent, and DBC file, bus load and
capacities contain it without another change.

    new_message.py COMPILER SOURCE
Exit 0: they do; 1: something differs.
"""
import pathlib
import sys

sys.dont_write_bytecode = True
import changes

TABLE, NODE = "kernels/wire/can_messages.hpp", "nodes/pack_can.cpp"
CHANGES = {
    TABLE: [
        ("}  // namespace can_table", """inline constexpr std::array<CanSignal, 1> k_temperature{
    {{"Temperature", {0, 16, intel_signed}, 0.01, {"degC", 1}}}};

}  // namespace can_table"""),
        ("std::array<CanMessageLayout, 12> k_can_messages{{", """std::array<CanMessageLayout, 13> k_can_messages{{
    {"Temperature", CanIdentifierRule::of_bus, 0xD, 2, CanFormat::classic, 1000,
     can_table::k_temperature, "Of the camera."},"""),
    ],
    NODE: [
        ("      frames.add(follow_up.value);", """      frames.add(follow_up.value);
      constexpr const CanMessageLayout& m = can_message("Temperature");
      CanFrame temperature =
          frame_of(m, identifier_of(m, {.base = settings.base_identifier}));
      put(temperature.data, m.signal("Temperature"), 3725);
      frames.add(temperature);"""),
        ('"node_frames")] += 2;', '"node_frames")] += 3;'),
    ],
}
SOURCES = [f"kernels/wire/{name}.cpp" for name in
           ("can_frames", "crc", "e2e", "node_frames", "smallest_three")]
SOURCES += [NODE, "platform/sinks/can/dbc.cpp", "schedules/bus_load.cpp"]
PROGRAM = """
#include <iostream>
namespace glint {
static_assert(k_can_periodic_frames == 4 && k_can_node_frames_max == 4 + k_tools_max);
static_assert(PackCan::worst({.tools = 2})[3] == 4);
}
int main() {
  using namespace glint;
  static CanFrames frames;
  PackCan pack;
  Now now;
  now.tick = Time{} + milliseconds(1);
  pack(now, {}, frames);
  for (const CanFrame& frame : frames.frames())
    std::cout << "frame " << frame.identifier << " " << int{frame.length} << " "
              << frame.data[0] + 256 * frame.data[1] << "\\n";
  std::cout << "hz " << bus_load({1, 100, CanFormat::classic}, {}).frames_per_second << "\\n"
            << dbc_text({.address = {0x1A0, 32}, .tools = {"pen"}});
}
"""
EXPECTED = [
    "frame 429 2 3725", "hz 513", "BO_ 429 Temperature: 2 Glint",
    ' SG_ Temperature : 0|16@1- (0.01,0) [-327.68|327.67] "degC" Controller',
    'CM_ BO_ 429 "Of the camera.";', 'BA_ "GenMsgCycleTime" BO_ 429 1000;']


def main():
    printed = changes.printed_lines(sys.argv[1], pathlib.Path(sys.argv[2]).resolve(), CHANGES,
                                    SOURCES, PROGRAM)
    missing = [line for line in EXPECTED if line not in printed]
    print("\n".join(f"not printed: {line}" for line in missing))
    print(f"{len(EXPECTED) - len(missing)} of {len(EXPECTED)} lines, {len(CHANGES)} files changed")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
