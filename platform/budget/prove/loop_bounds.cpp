#include "platform/budget/prove/loop_bounds.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <sstream>

#include "platform/cells/toml_reader.hpp"
#include "platform/input_error.hpp"
#include "platform/read_file.hpp"

namespace glint::prove {
namespace {

constexpr std::size_t k_no_depth = std::numeric_limits<std::size_t>::max();

std::string trimmed(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> lines_of(const std::string& file) {
  std::istringstream text(read_file(file, k_text_bytes_max, "a source file"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(trimmed(line));
  return lines;
}

// "57-71", or "57" for a statement of one line
void read_lines(const std::string& key, LoopEntry& entry) {
  int used = 0;
  const int read = std::sscanf(key.c_str(), "%7d-%7d%n", &entry.first, &entry.last, &used);
  if (read == 1) {
    entry.last = entry.first;
    used = static_cast<int>(std::to_string(entry.first).size());
  }
  if (read < 1 || used != static_cast<int>(key.size()) || entry.first < 1 ||
      entry.last < entry.first) {
    throw InputError(entry.place + ": \"" + key + "\": expected lines, as \"57-71\"");
  }
}

void check_text(const LoopEntry& entry, const std::vector<std::string>& lines) {
  const auto first = static_cast<std::size_t>(entry.first);
  if (first <= lines.size() && lines[first - 1] == entry.text) return;
  const auto now = std::find(lines.begin(), lines.end(), entry.text);
  throw InputError(entry.place + ": " + entry.line_text() + ": expected \"" + entry.text +
                   "\", found \"" + (first <= lines.size() ? lines[first - 1] : "") + "\"" +
                   (now == lines.end()
                        ? "; no line has this text"
                        : "; line " + std::to_string(now - lines.begin() + 1) + " has it"));
}

LoopEntry loop_entry(const std::string& file, const std::string& source, const std::string& key,
                     const toml::node& value) {
  LoopEntry entry;
  entry.place = file + ":" + std::to_string(value.source().begin.line);
  entry.file = source;
  read_lines(key, entry);
  const toml::table* fields = value.as_table();
  if (fields == nullptr) throw InputError(entry.place + ": expected { text, at_most, total }");
  TomlReader reader(*fields, file, entry.line_text() + ".");
  entry.text = reader.text("text", "");
  entry.at_most = reader.text("at_most", "");
  entry.per = reader.text("per", "");
  entry.in_each = reader.text("in_each", "");
  entry.also = reader.texts("also");
  entry.together = reader.boolean("together", false);
  entry.each = reader.boolean("each", false);
  entry.jumps_from = reader.texts("jumps_from");
  if (const toml::table* totals = reader.table("total"); totals != nullptr) {
    TomlReader of_total(*totals, file, entry.line_text() + ".total.");
    for (const auto& [kernel, total] : *totals) {
      const std::string name(kernel.str());
      entry.total[name] = of_total.text(name.c_str(), "");
    }
  }
  reader.done();
  if (entry.at_most.empty() && entry.total.empty()) {
    throw InputError(entry.place + ": expected at_most, total or both");
  }
  return entry;
}

std::vector<LoopEntry> entries_of(const toml::table* table, const std::string& file,
                                  const std::string& source_folder) {
  std::vector<LoopEntry> entries;
  if (table == nullptr) return entries;
  TomlReader sources(*table, file, "");
  for (const auto& [source, of_source] : *table) {
    const std::string name(source.str());
    const std::vector<std::string> lines = lines_of(source_folder + "/" + name);
    const toml::table* of_lines = sources.table(name.c_str());
    if (of_lines == nullptr) continue;
    for (const auto& [key, fields] : *of_lines) {
      entries.push_back(loop_entry(file, name, std::string(key.str()), fields));
      check_text(entries.back(), lines);
    }
  }
  return entries;
}

bool is_line(const SourceLine& at, const std::string& file_and_line) {
  const std::string line = ":" + std::to_string(at.line);
  return file_and_line.ends_with(line) &&
         is_file(at.file, file_and_line.substr(0, file_and_line.size() - line.size()));
}

// The instruction comes from the entry's lines, or its line is unknown.
bool contains(const LoopEntry& entry, const std::vector<SourceLine>& frames) {
  if (frames.empty() || frames.front().line == 0) return true;
  return std::any_of(frames.begin(), frames.end(), [&](const SourceLine& at) {
    const bool is_inside = at.line >= entry.first && at.line <= entry.last;
    return (is_inside && is_file(at.file, entry.file)) ||
           std::any_of(entry.also.begin(), entry.also.end(),
                       [&](const std::string& line) { return is_line(at, line); });
  });
}

// The first entry that contains a line of the innermost frame that has one.
const LoopEntry* entry_of_line(const std::vector<LoopEntry>& entries,
                               const std::vector<SourceLine>& frames) {
  for (const SourceLine& frame : frames) {
    for (const LoopEntry& entry : entries) {
      if (frame.line >= entry.first && frame.line <= entry.last && is_file(frame.file, entry.file))
        return &entry;
    }
  }
  return nullptr;
}

}  // namespace

LoopBounds::LoopBounds(const std::string& file, const std::string& source_folder) {
  const toml::table root = parse_toml(read_text(file), file);
  TomlReader reader(root, file, "");
  if (const toml::table* kernels = reader.table("kernels"); kernels != nullptr) {
    TomlReader names(*kernels, file, "kernels.");
    for (const auto& [kernel, functions] : *kernels) {
      kernels_[std::string(kernel.str())] = names.texts(std::string(kernel.str()).c_str());
    }
  }
  loops_ = entries_of(reader.table("loops"), file, source_folder);
  copies_ = entries_of(reader.table("copies"), file, source_folder);
  calls_ = entries_of(reader.table("calls"), file, source_folder);
  reader.done();
}

const LoopEntry* LoopBounds::entry_of_copy(const std::vector<SourceLine>& frames) const {
  return entry_of_line(copies_, frames);
}

const LoopEntry* LoopBounds::entry_of_call(const std::vector<SourceLine>& frames) const {
  return entry_of_line(calls_, frames);
}

LoopMatch LoopBounds::match(const FunctionGraph& graph, const Loop& loop,
                            const SourceLines& lines) const {
  std::vector<std::uint64_t> addresses, jumps_back;
  for (const int number : loop.blocks) {
    for (const Instruction& one : graph.blocks[static_cast<std::size_t>(number)].instructions) {
      addresses.push_back(one.address);
    }
  }
  for (const int number : loop.latches) {
    jumps_back.push_back(
        graph.blocks[static_cast<std::size_t>(number)].instructions.back().address);
  }
  LoopMatch match;
  std::size_t best_depth = 0;
  for (const LoopEntry& entry : loops_) {
    const auto starts = [&](const SourceLine& at) {
      return is_line(at, entry.line_text()) ||
             std::any_of(entry.jumps_from.begin(), entry.jumps_from.end(),
                         [&](const std::string& line) { return is_line(at, line); });
    };
    // Number of inlined calls between the jump back and the entry's line; an inner loop has fewer.
    std::size_t depth = k_no_depth;
    for (const std::uint64_t jump : jumps_back) {
      const std::vector<SourceLine>& frames = lines.of(jump);
      const auto found = std::find_if(frames.begin(), frames.end(), starts);
      if (found == frames.end()) continue;
      depth = std::min(depth, static_cast<std::size_t>(found - frames.begin()));
    }
    if (depth == k_no_depth) continue;
    const auto outside =
        std::find_if(addresses.begin(), addresses.end(),
                     [&](std::uint64_t address) { return !contains(entry, lines.of(address)); });
    if (outside != addresses.end()) {
      match.near = &entry;
      match.outside = *outside;
    } else if (match.entry == nullptr || depth < best_depth ||
               (depth == best_depth &&
                entry.last - entry.first < match.entry->last - match.entry->first)) {
      match.entry = &entry;
      best_depth = depth;
    }
  }
  return match;
}

}  // namespace glint::prove
