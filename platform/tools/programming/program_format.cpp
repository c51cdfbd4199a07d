#include "platform/tools/programming/program_format.hpp"

#include <filesystem>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/tools/programming/fanuc_ls.hpp"
#include "platform/tools/programming/krl.hpp"
#include "platform/tools/programming/path_csv.hpp"
#include "platform/tools/programming/program_text.hpp"
#include "platform/tools/programming/rapid.hpp"
#include "platform/tools/programming/ur_script.hpp"

namespace glint {
namespace {

struct Entry {
  ProgramFormat format;
  const char* name;
  const char* suffix;  // upper case
};

constexpr Entry k_formats[] = {{ProgramFormat::urscript, "urscript", ".SCRIPT"},
                               {ProgramFormat::krl, "krl", ".SRC"},
                               {ProgramFormat::rapid, "rapid", ".MOD"},
                               {ProgramFormat::ls, "ls", ".LS"},
                               {ProgramFormat::csv, "csv", ".CSV"},
                               {ProgramFormat::json, "json", ".JSON"},
                               {ProgramFormat::mcap, "mcap", ".MCAP"}};

}  // namespace

ProgramFormat program_format(const std::string& name, const std::string& file) {
  const std::string suffix = upper_case(std::filesystem::path(file).extension().string());
  for (const Entry& entry : k_formats) {
    if (name.empty() ? suffix == entry.suffix : name == entry.name) return entry.format;
  }
  if (!name.empty()) {
    throw InputError("--format: found \"" + printable(name) +
                     "\"; expected urscript, krl, rapid, ls, csv, json or mcap");
  }
  throw InputError(
      printable(file) +
      ": unknown suffix; expected .script, .src, .mod, .ls, .csv, .json or .mcap, or --format");
}

std::string program_name(const std::string& file) {
  std::string name = std::filesystem::path(file).stem().string();
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  for (char& c : name) {
    if (!letter(c) && !(c >= '0' && c <= '9')) c = '_';
  }
  return !name.empty() && letter(name.front()) ? name : "p_" + name;
}

std::string path_text(const StrokesFile& strokes, const ProgramSettings& settings,
                      ProgramFormat format) {
  if (format == ProgramFormat::csv) return path_csv(strokes.path);
  if (format == ProgramFormat::json) return strokes_json(strokes);
  if (settings.T_robot_user && settings.user_frame != 0 && format != ProgramFormat::ls) {
    throw InputError(
        "number of the user frame " + std::to_string(settings.user_frame) +
        " besides a drawn frame, which the program defines; expected 0, or the format ls");
  }
  const RobotProgram program = robot_program(strokes.path, settings);
  switch (format) {
    case ProgramFormat::krl:
      return krl(program);
    case ProgramFormat::rapid:
      return rapid(program);
    case ProgramFormat::ls:
      return fanuc_ls(program);
    default:
      return ur_script(program);
  }
}

}  // namespace glint
