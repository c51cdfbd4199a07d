#include "platform/cli/cell_option.hpp"

#include <cstdio>
#include <filesystem>
#include <string>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/session/recorded_cell.hpp"
#include "platform/sources/open_source.hpp"

namespace glint {
namespace {

constexpr const char* k_cell_option = "--config,--cell";

}  // namespace

void add_cell_option(CLI::App& command, std::string& file, const std::string& what) {
  command.add_option(k_cell_option, file, what)->type_name("FILE");
}

void add_cell_check(CLI::App& app) {
  const auto commands = app.get_subcommands([](CLI::App*) { return true; });
  for (CLI::App* command : commands) add_cell_check(*command);
  if (!commands.empty() || app.get_option_no_throw("--config") != nullptr) return;
  const auto check = [&app](const std::string& file) {
    (void)load_cell(file);
    std::fprintf(stderr, "note: %s: checked; `%s` uses no setting of a cell\n",
                 printable(file).c_str(), app.get_name().c_str());
  };
  app.add_option_function<std::string>(k_cell_option, check,
                                       "cell file: checked, not used by this command")
      ->type_name("FILE");
}

Cell cell_or_default(const std::string& file) {
  return file.empty() ? default_cell() : load_cell(file);
}

namespace {

std::string kind_of(const std::string& source, const std::string& stated) {
  if (source.empty() || !stated.empty()) return stated;
  const std::string kind = kind_at(source);
  if (!kind.empty()) return kind;
  if (!std::filesystem::is_directory(source)) return "recording";  // whose reader names the fault
  throw InputError(source +
                   ": no recorded frames in this folder; expected frames.csv, .mcap files, or "
                   "\"Depth AHaT.tar\" of StreamRecorder");
}

}  // namespace

Cell recorded_source_cell(const std::string& source, const std::string& config,
                          const std::string& stated, ReadTolerance tolerance) {
  const std::string kind = kind_of(source, stated);
  Cell cell;
  if (kind == "recording" && config.empty() && !source.empty()) {
    RecordingReader reader(source, tolerance);
    cell = recorded_cell(reader, source);
    cell.source = {};
  } else {
    cell = cell_or_default(config);
  }
  if (!source.empty()) {
    cell.source.kind = kind;
    cell.source.path = source;
    cell.source.place = (config.empty() ? source : config) + ": source";
  }
  if (cell.source.kind == "simulator") {
    throw InputError(
        "neither a source nor a [source] in the cell; expected recorded frames: a recording, a "
        "bag, a folder with frames.csv or a headset's capture");
  }
  return cell;
}

}  // namespace glint
