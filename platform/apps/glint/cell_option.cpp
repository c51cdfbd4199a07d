#include "platform/apps/glint/cell_option.hpp"

#include <cstdio>
#include <string>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"

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
    std::fprintf(stderr, "note: %s: checked; `%s` uses no cell setting\n", printable(file).c_str(),
                 app.get_name().c_str());
  };
  app.add_option_function<std::string>(k_cell_option, check,
                                       "cell file; only checked by this command")
      ->type_name("FILE");
}

Cell cell_or_default(const std::string& file) {
  return file.empty() ? default_cell() : load_cell(file);
}

}  // namespace glint
