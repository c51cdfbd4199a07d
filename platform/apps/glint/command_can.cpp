// glint can: the DBC file of a cell's CAN messages, and their layout as a C header.
#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "platform/apps/glint/cell_option.hpp"
#include "platform/apps/glint/commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/cells/cell.hpp"
#include "platform/part_file.hpp"
#include "platform/printable.hpp"
#include "platform/sinks/can/c_layout.hpp"
#include "platform/sinks/can/dbc.hpp"

namespace glint {
namespace {

struct DbcArguments {
  std::string config, json, out = "out/glint.dbc";
};

DbcBus bus_of(const Cell& cell) {
  DbcBus bus;
  bus.address = {cell.can.base_id, static_cast<std::uint32_t>(cell.can.node),
                 cell.can.buttons.value_or(0)};
  bus.format = cell.can.format;
  bus.tick_hz = cell.tick_hz;
  for (int t = 0; t < cell.tools.count; ++t)
    bus.tools.emplace_back(cell.tools.items[static_cast<std::size_t>(t)].name.data());
  return bus;
}

int write_dbc(const DbcArguments& arguments) {
  const DbcBus bus = bus_of(cell_or_default(arguments.config));
  write_text(arguments.out, dbc_text(bus));
  nlohmann::ordered_json figures{{"file", arguments.out},
                                 {"base_id", bus.address.base},
                                 {"node", bus.address.node},
                                 {"tools", nlohmann::ordered_json::object()}};
  const std::vector<std::string> prefixes = dbc_prefixes(bus.tools);
  const bool piped = is_special_file(arguments.out);  // the text may be on standard output
  if (!piped) std::printf("base_id  0x%X\nnode     %u\n", bus.address.base, bus.address.node);
  for (std::size_t t = 0; t < prefixes.size(); ++t) {
    figures["tools"][prefixes[t]] = bus.tools[t];
    if (!piped) {
      std::printf("tool     %s, messages %s...\n", printable(bus.tools[t]).c_str(),
                  prefixes[t].c_str());
    }
  }
  if (!piped) std::printf("written  %s\n", printable(arguments.out).c_str());
  write_json(arguments.json, figures);
  return 0;
}

void add_dbc(CLI::App& parent, int& exit_code) {
  CLI::App* command =
      parent.add_subcommand("dbc", "DBC file of every CAN message of a cell, with all its tools");
  auto arguments = std::make_shared<DbcArguments>();
  command->footer(
      "Example: glint can dbc --config cell.toml --out cell.dbc\n"
      "For SavvyCAN, PlotJuggler, canmatrix and others. It describes the pose messages of both\n"
      "frame formats; only those of [can] frames have a cycle time.");
  command->add_option("--out", arguments->out, "file to write")->capture_default_str();
  add_cell_option(*command, arguments->config);
  command->add_option("--json", arguments->json, "file for the figures of the table");
  command->callback([arguments, &exit_code] { exit_code = write_dbc(*arguments); });
}

void add_c_layout(CLI::App& parent, int& exit_code) {
  CLI::App* command =
      parent.add_subcommand("c-layout", "C header of a tool's messages, for a robot controller");
  auto out = std::make_shared<std::string>("out/glint_can_layout.h");
  command->footer(
      "Example: glint can c-layout --out glint_can_layout.h\n"
      "platform/sinks/can/controller holds the decoder that includes it.");
  command->add_option("--out", *out, "file to write")->capture_default_str();
  command->callback([out, &exit_code] {
    write_text(*out, c_layout_text());
    if (!is_special_file(*out)) std::printf("written  %s\n", printable(*out).c_str());
    exit_code = 0;
  });
}

}  // namespace

void add_can(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("can", "Description of the CAN messages for other programs");
  command->require_subcommand(1);
  command->footer("Example: glint can dbc --config cell.toml --out cell.dbc");
  add_dbc(*command, exit_code);
  add_c_layout(*command, exit_code);
}

}  // namespace glint
