#include "platform/budget/board_file.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "glint_built_in_boards.hpp"
#include "platform/cells/toml_reader.hpp"
#include "platform/input_error.hpp"
#include "platform/sinks/record/sha256.hpp"

namespace glint {
namespace {

constexpr double k_cost_max = 1e9;                // a count: one second, or 1e9 instructions
constexpr std::int64_t k_second = 1'000'000'000;  // largest system share in nanoseconds

class BoardReader {
 public:
  BoardReader(const toml::table& table, const std::string& file, const BoardExpectation& expected)
      : root_(table), reader_(table, file, ""), file_(file), expected_(expected) {}

  Board read(BoardUse use) {
    Board board;
    board.name = required_text("name", reader_, root_, "");
    read_build(board, use);
    read_graphs(board);
    const std::string counter = reader_.one_of("counter", "instructions", {"instructions", "time"});
    board.counter = counter == "time" ? CostCounter::time : CostCounter::instructions;
    board.ns_per_instruction = reader_.real("ns_per_instruction", 1, 1e-3, 1e3);
    read_provenance(board);
    read_system(board);
    read_kernels(board);
    reader_.done();
    compute_costs(board);
    return board;
  }

 private:
  [[noreturn]] void complain(const toml::node& where, const std::string& sentence) const {
    throw InputError(file_ + ":" + std::to_string(where.source().begin.line) + ": " + sentence);
  }
  const toml::table& section(const char* key, const char* holds) {
    const toml::table* table = reader_.table(key);
    if (table == nullptr) {
      complain(root_, "the table [" + std::string(key) + "] is missing; expected " + holds);
    }
    return *table;
  }
  std::string required_text(const char* key, TomlReader& reader, const toml::table& table,
                            const std::string& prefix) const {
    const std::string text = reader.text(key, "");
    if (text.empty()) complain(table, prefix + key + " is missing; expected a text in quotes");
    return text;
  }

  void read_build(Board& board, BoardUse use) {
    board.build = required_text("build", reader_, root_, "");
    const auto flags = [](const std::string& build) { return build.substr(build.find(' ') + 1); };
    const bool fits = use == BoardUse::run_here ? board.build == expected_.build
                                                : flags(board.build) == flags(expected_.build);
    if (!fits) {
      complain(*root_.get("build"), "build is \"" + board.build + "\"; expected \"" +
                                        expected_.build +
                                        "\", the build of this program (measure again)");
    }
  }

  void read_graphs(Board& board) {
    const toml::table& table = section("graphs", "the graph signatures of the measurement");
    TomlReader reader(table, file_, "graphs.");
    kernels_ = expected_.kernels;
    for (const GraphName& graph : expected_.graphs) read_graph(graph, table, reader, board);
    for (const BoardExpectation::Optional& optional : expected_.optional) {
      const char* const name = optional.graph.name.c_str();
      (void)reader.text(name, "");  // marks the key as known, present or not
      if (table.get(name) == nullptr) continue;
      read_graph(optional.graph, table, reader, board);
      kernels_.insert(kernels_.end(), optional.kernels.begin(), optional.kernels.end());
    }
    reader.done();
  }
  void read_graph(const GraphName& graph, const toml::table& table, TomlReader& reader,
                  Board& board) const {
    const std::string found = required_text(graph.name.c_str(), reader, table, "graphs.");
    if (found != graph.signature) {
      complain(*table.get(graph.name), "graphs." + graph.name + " is \"" + found +
                                           "\"; expected \"" + graph.signature +
                                           "\": the graph differs (measure again)");
    }
    board.graphs.push_back({graph.name, found});
  }

  void read_provenance(Board& board) {
    const toml::table& table = section("provenance", "the origin of the costs");
    TomlReader reader(table, file_, "provenance.");
    BoardProvenance& from = board.provenance;
    from.machine = required_text("machine", reader, table, "provenance.");
    from.kernel = reader.text("kernel", "");
    from.governor = reader.text("governor", "");
    from.version = reader.text("version", "");
    from.date = reader.text("date", "");
    from.command = reader.text("command", "");
    from.clock_mhz = reader.real("clock_mhz", 0, 0, 1e5);
    from.inputs = reader.integer("inputs", 0, 0, 1'000'000'000);
    from.margin_percent = reader.real("margin_percent", 0, 0, 1000);
    reader.done();
  }

  void read_system(Board& board) {
    const toml::table* table = reader_.table("system");
    if (table == nullptr) return;  // absent: every share is zero
    TomlReader reader(*table, file_, "system.");
    board.system.wake_up_ns = reader.integer("wake_up_ns", 0, 0, k_second);
    board.system.interrupt_ns = reader.integer("interrupt_ns", 0, 0, k_second);
    board.system.interrupt_gap_ns = reader.integer("interrupt_gap_ns", 0, 0, k_second);
    board.system.can_write_ns = reader.integer("can_write_ns", 0, 0, k_second);
    board.system.inter_core_delay_ns = reader.integer("core_handover_ns", 0, 0, k_second);
    reader.done();
  }

  void read_kernels(Board& board) {
    const toml::table& table = section("kernels", "a table for each kernel");
    TomlReader reader(table, file_, "kernels.");
    for (const KernelLoops& kernel : kernels_) {
      const std::string name(kernel.kernel);
      const toml::table* costs = reader.table(name.c_str());
      if (costs == nullptr) {
        complain(table, "kernels." + name + " is missing; expected its costs of " +
                            loops_in_words(kernel));
      }
      board.kernels.push_back({kernel, read_costs(*costs, kernel)});
    }
    reader.done();
  }

  std::vector<double> read_costs(const toml::table& table, const KernelLoops& kernel) const {
    const std::string prefix = "kernels." + std::string(kernel.kernel) + ".";
    TomlReader reader(table, file_, prefix);
    std::vector<double> costs;
    for (const std::string_view loop : kernel.loops) {
      const std::string key(loop);
      if (table.get(key) == nullptr) {
        complain(table, prefix + key + " is missing; expected costs of " + loops_in_words(kernel));
      }
      costs.push_back(reader.real(key.c_str(), 0, 0, k_cost_max));
    }
    reader.done();
    return costs;
  }

  static std::string loops_in_words(const KernelLoops& kernel) {
    std::string words;
    for (const std::string_view loop : kernel.loops) {
      words += (words.empty() ? "" : ", ") + std::string(loop);
    }
    return words;
  }

  const toml::table& root_;
  TomlReader reader_;
  const std::string& file_;
  const BoardExpectation& expected_;
  std::vector<KernelLoops> kernels_;  // of the graphs in the board file
};

}  // namespace

void compute_costs(Board& board) {
  board.costs.clear();
  for (const BoardKernel& kernel : board.kernels) {
    KernelCost cost;
    cost.kernel = kernel.loops.kernel;
    for (std::size_t loop = 0; loop < kernel.cost.size(); ++loop) {
      cost.loops[loop] = kernel.loops.loops[loop];
      cost.cost_ps[loop] =
          static_cast<std::int64_t>(std::ceil(kernel.cost[loop] * board.ns_per_instruction * 1000));
    }
    board.costs.push_back(cost);
  }
}

Board parse_board(const std::string& text, const std::string& file,
                  const BoardExpectation& expected, BoardUse use) {
  const toml::table table = parse_toml(text, file);
  Board board = BoardReader(table, file, expected).read(use);
  Sha256 hash;
  hash.add(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  board.sha256 = hash.hex();
  return board;
}

std::vector<std::string> built_in_boards() {
  std::vector<std::string> names;
  for (const BuiltInBoard& board : k_built_in_boards) names.emplace_back(board.name);
  return names;
}

Board load_board(const std::string& name_or_path, const BoardExpectation& expected, BoardUse use) {
  for (const BuiltInBoard& board : k_built_in_boards) {
    if (name_or_path != board.name) continue;
    return parse_board(std::string(board.text), "boards/" + name_or_path + ".toml", expected, use);
  }
  if (name_or_path.find_first_of("./") == std::string::npos) {
    std::string names;
    for (const std::string& name : built_in_boards()) names += ", \"" + name + "\"";
    throw InputError("board \"" + name_or_path + "\" is not built in; expected a file" + names);
  }
  return parse_board(read_text(name_or_path), name_or_path, expected, use);
}

}  // namespace glint
