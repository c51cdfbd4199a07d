#include "platform/budget/prove/source_lines.hpp"

#include <dwarf.h>
#include <elfutils/libdw.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <string_view>

#include "platform/input_error.hpp"

namespace glint::prove {
namespace {

// The project's part of a path: from its last folder of the top level on.
std::string_view project_part(std::string_view file) {
  constexpr std::array<std::string_view, 6> k_folders = {"kernels/",   "graph/",    "nodes/",
                                                         "schedules/", "platform/", "tests/"};
  if (file.starts_with("/usr/")) return {};
  std::size_t best = std::string_view::npos;
  for (const std::string_view folder : k_folders) {
    std::size_t at = file.find(folder);
    while (at != std::string_view::npos && at != 0 && file[at - 1] != '/') {
      at = file.find(folder, at + 1);
    }
    best = std::min(best, at);
  }
  return best == std::string_view::npos ? std::string_view() : file.substr(best);
}

}  // namespace

struct SourceLines::Dwarf {
  int file = -1;
  ::Dwarf* data = nullptr;
  std::map<std::uint64_t, std::vector<SourceLine>> read;
};

SourceLines::SourceLines(const std::string& program) : dwarf_(std::make_unique<Dwarf>()) {
  dwarf_->file = open(program.c_str(), O_RDONLY | O_CLOEXEC);
  if (dwarf_->file < 0) throw InputError(program + ": cannot be read; expected a program");
  dwarf_->data = dwarf_begin(dwarf_->file, DWARF_C_READ);
}

SourceLines::~SourceLines() {
  if (dwarf_->data != nullptr) dwarf_end(dwarf_->data);
  close(dwarf_->file);
}

bool SourceLines::empty() const { return dwarf_->data == nullptr; }

const std::vector<SourceLine>& SourceLines::of(std::uint64_t address) const {
  const auto found = dwarf_->read.find(address);
  if (found != dwarf_->read.end()) return found->second;
  return dwarf_->read[address] = read(address);
}

std::vector<SourceLine> SourceLines::read(std::uint64_t address) const {
  std::vector<SourceLine> frames;
  Dwarf_Die unit;
  if (empty() || dwarf_addrdie(dwarf_->data, address, &unit) == nullptr) return frames;
  SourceLine own;
  if (Dwarf_Line* line = dwarf_getsrc_die(&unit, address); line != nullptr) {
    const char* name = dwarf_linesrc(line, nullptr, nullptr);
    own.file = name == nullptr ? "" : name;
    (void)dwarf_lineno(line, &own.line);
  }
  frames.push_back(own);
  Dwarf_Files* files = nullptr;
  std::size_t file_count = 0;
  (void)dwarf_getsrcfiles(&unit, &files, &file_count);
  Dwarf_Die* scopes = nullptr;
  if (dwarf_getscopes(&unit, address, &scopes) <= 0) return frames;
  // The scopes of an inlined call continue with those of its definition; its callers are the
  // parents of the innermost entry.
  Dwarf_Die* parents = nullptr;
  const int count = dwarf_getscopes_die(&scopes[0], &parents);
  for (int i = 0; i < count; ++i) {
    if (dwarf_tag(&parents[i]) != DW_TAG_inlined_subroutine) continue;
    Dwarf_Attribute attribute;
    Dwarf_Word file = 0, line = 0;
    (void)dwarf_formudata(dwarf_attr(&parents[i], DW_AT_call_file, &attribute), &file);
    (void)dwarf_formudata(dwarf_attr(&parents[i], DW_AT_call_line, &attribute), &line);
    const char* name = file < file_count ? dwarf_filesrc(files, file, nullptr, nullptr) : nullptr;
    frames.push_back({name == nullptr ? "" : name, static_cast<int>(line)});
  }
  std::free(parents);
  std::free(scopes);
  return frames;
}

bool is_file(const std::string& file, const std::string& project_file) {
  return file == project_file || file.ends_with("/" + project_file);
}

std::string place_text(const std::vector<SourceLine>& frames) {
  std::string text;
  for (const SourceLine& frame : frames) {
    const std::string_view part = project_part(frame.file);
    if (part.empty() || frame.line == 0) continue;
    text += (text.empty() ? "" : " in ") + std::string(part) + ":" + std::to_string(frame.line);
  }
  return text;
}

}  // namespace glint::prove
