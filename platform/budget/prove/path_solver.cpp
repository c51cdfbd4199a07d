#include "platform/budget/prove/path_solver.hpp"

#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "platform/budget/measure/child_program.hpp"
#include "platform/input_error.hpp"

namespace glint::prove {
namespace {

// Variables: x0.. one for each edge, then one for each function's entry, then one for each block
// that leaves.
class Program {
 public:
  explicit Program(const PathGraph& graph) : graph_(graph), roles_(roles_of(graph)) {
    for (std::size_t edge = 0; edge < graph.edges.size(); ++edge) {
      add(graph.edges[edge].first, graph.edges[edge].second, roles_.edges[edge]);
    }
    for (std::size_t function = 0; function < graph.functions.size(); ++function) {
      entry_.push_back(variables_);
      add(-1, roles_.entry_of_function[function], roles_.entries[function]);
    }
    for (std::size_t block = 0; block < graph.blocks.size(); ++block) {
      if (graph.blocks[block].leaves) add(static_cast<int>(block), -1, EdgeRole::plain);
    }
  }

  std::string text() const {
    std::string text = "Maximize\n longest:" + terms(objective_) + "\nSubject To\n";
    for (std::size_t block = 0; block < graph_.blocks.size(); ++block) {
      text += row("b", block, balance_, static_cast<int>(block), "= 0");
    }
    for (std::size_t function = 0; function + 1 < graph_.functions.size(); ++function) {
      std::map<int, double> entered;
      if (const auto calls = calls_.find(static_cast<int>(function)); calls != calls_.end()) {
        entered = calls->second;
      }
      entered[entry_[function]] -= 1;
      text += " f" + std::to_string(function) + ":" + terms(entered) + " = 0\n";
    }
    text += " root: x" + std::to_string(entry_.back()) + " = 1\n";
    for (std::size_t loop = 0; loop < graph_.loops.size(); ++loop) {
      text += row("l", loop, repeats_, static_cast<int>(loop), "<= 0");
    }
    for (std::size_t total = 0; total < graph_.totals.size(); ++total) {
      text += " t" + std::to_string(total) + ":" + terms(together(graph_.totals[total])) + " <= " +
              std::to_string(graph_.totals[total].scope < 0 ? graph_.totals[total].at_most : 0) +
              "\n";
    }
    return text + "End\n";
  }

  // Executions of each block, from the values of the variables.
  std::vector<double> runs(const std::vector<double>& values) const {
    std::vector<double> runs(graph_.blocks.size(), 0);
    for (const auto& [block, of_block] : balance_) {
      for (const auto& [variable, sign] : of_block) {
        if (sign > 0) {
          runs[static_cast<std::size_t>(block)] += values[static_cast<std::size_t>(variable)];
        }
      }
    }
    return runs;
  }
  int variables() const { return variables_; }

 private:
  using Row = std::map<int, double>;  // factor of each variable

  void add(int from, int to, EdgeRole role) {
    if (from >= 0) balance_[from][variables_] -= 1;
    if (to >= 0) {
      const PathBlock& block = graph_.blocks[static_cast<std::size_t>(to)];
      balance_[to][variables_] += 1;
      objective_[variables_] = static_cast<double>(block.cost);
      if (block.callee >= 0) calls_[block.callee][variables_] += 1;
      const int loop = roles_.loop_of_block[static_cast<std::size_t>(to)];
      if (role == EdgeRole::jumps_back) repeats_[loop][variables_] += 1;
      if (role == EdgeRole::enters) {
        enters_[to].push_back(variables_);
        repeats_[loop][variables_] -=
            static_cast<double>(graph_.loops[static_cast<std::size_t>(loop)].at_most);
      }
    }
    ++variables_;
  }

  Row together(const PathTotal& total) const {
    Row row;
    for (const int block : total.blocks) {
      if (total.of == PathTotal::Of::runs) {
        for (const auto& [variable, sign] : balance_.at(block)) row[variable] += sign > 0 ? 1 : 0;
        continue;
      }
      const int loop = roles_.loop_of_block[static_cast<std::size_t>(block)];
      for (const auto& [variable, factor] : repeats_.at(loop)) row[variable] += factor > 0 ? 1 : 0;
    }
    if (total.scope < 0) return row;
    for (const int variable : enters_.at(total.scope)) {
      row[variable] -= static_cast<double>(total.at_most);
    }
    return row;
  }

  static std::string terms(const Row& row) {
    std::ostringstream text;
    text.precision(17);
    int written = 0;
    for (const auto& [variable, factor] : row) {
      if (factor == 0) continue;
      if (++written % 8 == 0) text << "\n ";
      text << (factor < 0 ? " - " : " + ") << std::abs(factor) << " x" << variable;
    }
    if (written == 0) text << " 0 x0";
    return text.str();
  }
  static std::string row(const char* kind, std::size_t number, const std::map<int, Row>& rows,
                         int key, const std::string& right) {
    const auto found = rows.find(key);
    return " " + (kind + std::to_string(number)) + ":" +
           terms(found == rows.end() ? Row() : found->second) + " " + right + "\n";
  }

  const PathGraph& graph_;
  EdgeRoles roles_;
  int variables_ = 0;
  Row objective_;
  std::map<int, Row> balance_, calls_, repeats_;  // by block, by function called, by loop
  std::map<int, std::vector<int>> enters_;        // by header
  std::vector<int> entry_;
};

}  // namespace

std::string program_text(const PathGraph& graph) { return Program(graph).text(); }

PathSolution solve(const PathGraph& graph, const std::string& folder) {
  const Program program(graph);
  if (!(std::ofstream(folder + "/path.lp") << program.text()).flush()) {
    throw InputError(folder + "/path.lp: cannot be written");
  }
  const int process = start_program(
      {"cbc", "path.lp", "-printingOptions", "all", "-solve", "-solution", "path.sol"}, folder,
      "cbc.txt");
  int status = 0;
  if (process < 0 || waitpid(process, &status, 0) != process) {
    throw std::runtime_error("cbc: cannot be started");
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) {
    throw MissingDevice("cbc: not found; expected the package coinor-cbc");
  }
  std::ifstream file(folder + "/path.sol");
  std::string line;
  if (!std::getline(file, line) || !line.starts_with("Optimal")) {
    throw std::runtime_error(graph.kernel + ": cbc found no longest path: " + line + "; see " +
                             folder + "/cbc.txt");
  }
  PathSolution solution;
  solution.totals.assign(graph.totals.size(), 0);
  solution.whole = true;
  std::vector<double> values(static_cast<std::size_t>(program.variables()), 0);
  solution.longest = std::strtod(line.c_str() + line.rfind(' '), nullptr);
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string number, name;
    double value = 0, dual = 0;
    if (!(words >> number >> name) || name.size() < 2) continue;
    if (number == "**" && !(words >> name)) continue;  // cbc marks a value outside its limits
    if (!(words >> value >> dual)) continue;
    const std::size_t index = std::strtoul(name.c_str() + 1, nullptr, 10);
    if (name[0] == 't') solution.totals.at(index) = dual;
    if (name[0] == 'x') {
      values.at(index) = value;
      solution.whole = solution.whole && std::abs(value - std::round(value)) < 1e-6;
    }
  }
  solution.runs = program.runs(values);
  return solution;
}

}  // namespace glint::prove
