#include "platform/budget/plan_file.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "platform/cells/toml_reader.hpp"
#include "platform/input_error.hpp"
#include "schedules/static_order.hpp"
#include "schedules/synthesis.hpp"

namespace glint {
namespace {

class PlanParser {
 public:
  PlanParser(const std::string& file, const TaskModel& model, const std::string& signature)
      : file_(file), model_(model), signature_(signature) {}

  Plan parse(const toml::table& table) {
    TomlReader root(table, file_, "");
    plan_.graph_signature = root.text("graph", "");
    if (plan_.graph_signature != signature_) {
      fail(table.get("graph"), "graph is \"" + plan_.graph_signature + "\"; expected \"" +
                                   signature_ + "\", this program's graphs of the cell's groups " +
                                   group_names());
    }
    plan_.board = root.text("board", "");
    plan_.board_sha256 = root.text("board_sha256", "");
    plan_.cores = static_cast<int>(root.integer("cores", 1, 1, k_plan_cores_max));
    read_bus(root.table("bus"));
    read_groups(root.tables("group"));
    root.done();
    return plan_;
  }

 private:
  struct PlannedNodeLine {
    int line = 0;
    std::optional<std::int64_t> start_ns;
    std::int64_t bound_ns = 0;
  };

  [[noreturn]] void fail(int line, const std::string& what) const {
    throw InputError(file_ + ":" + std::to_string(line) + ": " + what);
  }
  [[noreturn]] void fail(const toml::node* node, const std::string& what) const {
    fail(node != nullptr ? line_of(*node) : 1, what);
  }
  static int line_of(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

  void read_bus(const toml::table* table) {
    if (table == nullptr) fail(1, "no [bus]; expected frames, bit_rate, tools and tick_hz");
    TomlReader reader(*table, file_, "bus.");
    plan_.traffic.format =
        can_format_of(reader.one_of("frames", "classic", {"classic", "fd", "fd_covariance"}));
    plan_.bus.nominal =
        static_cast<double>(reader.integer("bit_rate", 1'000'000, 10'000, 1'000'000));
    plan_.bus.data =
        static_cast<double>(reader.integer("data_bit_rate", 4'000'000, 10'000, 8'000'000));
    plan_.traffic.tools = static_cast<int>(reader.integer("tools", 1, 1, k_tools_max));
    plan_.traffic.tick_hz = reader.real("tick_hz", 250, 1, 1600);
    reader.done();
    if (const auto complaint = check_bus_load(plan_.traffic, plan_.bus)) {
      CanTraffic fits = plan_.traffic;
      while (fits.tools > 1 && check_bus_load(fits, plan_.bus)) --fits.tools;
      const bool found = !check_bus_load(fits, plan_.bus);
      fail(table, *complaint + (found ? "; " + std::to_string(fits.tools) + " would fit" : ""));
    }
  }

  void read_groups(const std::vector<const toml::table*>& tables) {
    std::vector<const toml::table*> by_group(model_.groups.size(), nullptr);
    for (const toml::table* table : tables) {
      const std::string name = table->get("name") != nullptr
                                   ? table->get("name")->value_or(std::string())
                                   : std::string();
      const auto g = index_of_group(name);
      if (!g) fail(table, "group \"" + name + "\"; expected one of " + group_names());
      if (by_group[*g] != nullptr) fail(table, "a second group \"" + name + "\"; expected one");
      by_group[*g] = table;
    }
    for (std::size_t g = 0; g < by_group.size(); ++g) {
      if (by_group[g] == nullptr) {
        fail(1, "no group \"" + model_.groups[g].name + "\"; expected one of each of " +
                    group_names());
      }
      read_group(g, *by_group[g]);
    }
  }

  void read_group(std::size_t g, const toml::table& table) {
    TomlReader reader(table, file_, "group.");
    PlannedGroup group;
    group.name = reader.text("name", "");
    group.priority = static_cast<int>(reader.integer("priority", 1, 1, 99));
    group.optimal = reader.boolean("optimal", false);
    group.makespan_lower_bound_ns = reader.integer("least_possible_ns", 0, 0, INT64_MAX);
    const std::vector<const toml::table*> nodes = reader.tables("nodes");
    reader.done();

    std::map<int, PlannedNodeLine> lines;
    std::vector<std::vector<int>> orders(static_cast<std::size_t>(plan_.cores));
    for (const toml::table* node : nodes) read_node(g, *node, lines, orders);
    for (std::size_t n = 0; n < model_.groups[g].nodes.size(); ++n) {
      if (lines.count(static_cast<int>(n)) != 0) continue;
      fail(&table, "group \"" + group.name + "\" leaves out " +
                       node_name(model_.groups[g].nodes[n]) + "; expected every node once");
    }
    compute_starts(g, lines, orders, group);
    plan_.groups.push_back(group);
  }

  void read_node(std::size_t g, const toml::table& table, std::map<int, PlannedNodeLine>& lines,
                 std::vector<std::vector<int>>& orders) {
    TomlReader reader(table, file_, "group.nodes.");
    const std::string name = reader.text("node", "");
    const std::int64_t core = reader.integer("core", 0, INT32_MIN, INT32_MAX);
    const std::int64_t start = reader.integer("start_ns", -1, 0, INT64_MAX);
    const std::int64_t bound = reader.integer("bound_ns", 0, 0, INT64_MAX);
    reader.done();
    const auto n = index_of_node(g, name);
    if (!n) {
      fail(&table, "node \"" + name + "\" is not in group \"" + model_.groups[g].name +
                       "\"; expected one of " + node_names(g));
    }
    if (core < 0 || core >= plan_.cores) {
      fail(&table, name + " on core " + std::to_string(core) + "; expected 0 to " +
                       std::to_string(plan_.cores - 1));
    }
    if (lines.count(*n) != 0) {
      fail(&table, name + " occurs again, first in line " + std::to_string(lines[*n].line) +
                       "; expected every node once");
    }
    lines[*n] = {line_of(table), start < 0 ? std::nullopt : std::optional(start), bound};
    orders[static_cast<std::size_t>(core)].push_back(*n);
  }

  // Checks the given start times; computes the missing ones.
  void compute_starts(std::size_t g, std::map<int, PlannedNodeLine>& lines,
                      const std::vector<std::vector<int>>& orders, PlannedGroup& group) {
    TaskGroup bounded = model_.groups[g];
    for (auto& [n, node_line] : lines) {
      bounded.nodes[static_cast<std::size_t>(n)].bound_ns = node_line.bound_ns;
    }
    const auto times = times_of(bounded, orders, model_.system.inter_core_delay_ns);
    if (!times) fail_on_cycle(g, lines, orders);
    for (std::size_t core = 0; core < orders.size(); ++core) {
      for (const int n : orders[core]) {
        const PlannedNodeLine& node_line = lines[n];
        const std::int64_t earliest = times->start_ns[static_cast<std::size_t>(n)];
        if (node_line.start_ns && *node_line.start_ns < earliest) {
          fail(node_line.line, node_name(bounded.nodes[static_cast<std::size_t>(n)]) +
                                   " starts at " + std::to_string(*node_line.start_ns) +
                                   " ns; expected at least " + std::to_string(earliest) +
                                   ", after its inputs");
        }
        plan_.nodes.push_back({static_cast<int>(g), n, static_cast<int>(core), earliest,
                               earliest + node_line.bound_ns});
      }
    }
    group.makespan_ns = times->makespan_ns;
  }

  // Names the first node that waits for one which its core or another runs only after it.
  [[noreturn]] void fail_on_cycle(std::size_t g, const std::map<int, PlannedNodeLine>& lines,
                                  const std::vector<std::vector<int>>& orders) const {
    std::vector<bool> ran(model_.groups[g].nodes.size(), false);
    std::vector<std::size_t> next(orders.size(), 0);
    const auto waits_for = [&](int n) {
      for (const int before : model_.groups[g].nodes[static_cast<std::size_t>(n)].after) {
        if (!ran[static_cast<std::size_t>(before)]) return before;
      }
      return -1;
    };
    for (bool moved = true; moved;) {
      moved = false;
      for (std::size_t core = 0; core < orders.size(); ++core) {
        while (next[core] < orders[core].size() && waits_for(orders[core][next[core]]) < 0) {
          ran[static_cast<std::size_t>(orders[core][next[core]++])] = moved = true;
        }
      }
    }
    int line = INT32_MAX, stuck = 0;
    for (std::size_t core = 0; core < orders.size(); ++core) {
      if (next[core] == orders[core].size()) continue;
      const int n = orders[core][next[core]];
      if (lines.at(n).line < line) {
        line = lines.at(n).line;
        stuck = n;
      }
    }
    const auto name = [&](int n) {
      return node_name(model_.groups[g].nodes[static_cast<std::size_t>(n)]);
    };
    fail(line, "a cycle: " + name(stuck) + " waits for " + name(waits_for(stuck)) +
                   ", which in these orders runs after it; expected it before");
  }

  [[nodiscard]] std::optional<std::size_t> index_of_group(const std::string& name) const {
    for (std::size_t g = 0; g < model_.groups.size(); ++g) {
      if (model_.groups[g].name == name) return g;
    }
    return std::nullopt;
  }
  [[nodiscard]] std::optional<int> index_of_node(std::size_t g, const std::string& name) const {
    const auto& nodes = model_.groups[g].nodes;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (node_name(nodes[n]) == name) return static_cast<int>(n);
    }
    return std::nullopt;
  }
  [[nodiscard]] std::string group_names() const {
    std::string names;
    for (const TaskGroup& group : model_.groups) names += (names.empty() ? "" : ", ") + group.name;
    return names;
  }
  [[nodiscard]] std::string node_names(std::size_t g) const {
    std::string names;
    for (const TaskNode& node : model_.groups[g].nodes) {
      names += (names.empty() ? "" : ", ") + node_name(node);
    }
    return names;
  }

  const std::string& file_;
  const TaskModel& model_;
  const std::string& signature_;
  Plan plan_;
};

}  // namespace

Plan plan_from_text(const std::string& text, const std::string& file, const TaskModel& model,
                    const std::string& signature) {
  return PlanParser(file, model, signature).parse(parse_toml(text, file));
}

Plan load_plan(const std::string& file, const TaskModel& model, const std::string& signature) {
  return plan_from_text(read_text(file), file, model, signature);
}

}  // namespace glint
