#include "platform/budget/prove/prove.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "platform/budget/prove/callee.hpp"
#include "platform/input_error.hpp"
#include "platform/sinks/record/sha256.hpp"

namespace glint::prove {
namespace {

std::string hash_of(const std::string& text) {
  Sha256 hash;
  hash.add({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return hash.hex();
}

const FunctionSymbol* root_of(const ProgramCode& code, const std::vector<std::string>& names,
                              std::vector<std::string>& reasons) {
  std::string list;
  for (const std::string& name : names) {
    const auto found = code.functions_named(name);
    if (found.size() == 1) return found.front();
    if (found.size() > 1) {
      reasons.push_back("several functions start with " + name);
      return nullptr;
    }
    list += (list.empty() ? "" : ", ") + name;
  }
  reasons.push_back("no function of the program starts with " + list);
  return nullptr;
}

PathGraph path_graph_of(const ProgramCode& code, const CallGraph& calls) {
  PathGraph graph;
  graph.machine = name_of(code.machine());
  graph.code_sha256 = code_sha256(code, calls);
  for (std::size_t index = 0; index < calls.functions.size(); ++index) {
    const FunctionGraph& function = calls.functions[index];
    const int first = static_cast<int>(graph.blocks.size());
    const FunctionSymbol* symbol = code.function_at(function.address);
    graph.functions.push_back(symbol == nullptr ? code.text_of(function.address)
                                                : short_name(symbol->name));
    for (const Block& block : function.blocks) {
      for (const int to : block.successors) {
        graph.edges.emplace_back(static_cast<int>(graph.blocks.size()), first + to);
      }
      graph.blocks.push_back({static_cast<int>(index), block.cost,
                              block.callee ? calls.index_of(*block.callee) : -1, block.leaves,
                              block.address, ""});
    }
  }
  return graph;
}

bool is_around(const FunctionGraph& function, std::size_t outer, std::size_t inner) {
  const std::vector<int>& around = function.loops[outer].blocks;
  return std::find(around.begin(), around.end(), function.loops[inner].header) != around.end();
}

}  // namespace

Prover::Prover(const std::string& program, const std::string& lines, const LoopBounds& bounds,
               const NamedCounts& limits)
    : code_(program), lines_code_(lines), lines_(lines), bounds_(bounds), limits_(limits) {}

std::string Prover::place_of(std::uint64_t address) const {
  const std::string line = place_text(lines_.of(address));
  return code_.text_of(address) + (line.empty() ? "" : " (" + line + ")");
}

void Prover::check_same_code(const CallGraph& calls, KernelProof& proof) const {
  for (const FunctionGraph& function : calls.functions) {
    for (const Block& block : function.blocks) {
      for (const Instruction& one : block.instructions) {
        const auto bytes = code_.bytes_at(one.address), others = lines_code_.bytes_at(one.address);
        const auto size = static_cast<std::size_t>(one.size);
        if (others.size() >= size &&
            std::equal(bytes.begin(), bytes.begin() + one.size, others.begin())) {
          continue;
        }
        proof.reasons.push_back(lines_code_.path() + " has other code at " +
                                code_.text_of(one.address));
        return;
      }
    }
  }
}

void Prover::add_library_costs(const CallGraph& calls, KernelProof& proof) const {
  std::set<std::string> declared;
  std::size_t number = 0;
  for (const FunctionGraph& function : calls.functions) {
    for (const Block& block : function.blocks) {
      PathBlock& path_block = proof.graph.blocks[number++];
      for (const Instruction& repeated : block.uncounted) {
        const LoopEntry* entry = bounds_.entry_of_copy(lines_.of(repeated.address));
        if (entry == nullptr) {
          proof.reasons.push_back("an unbounded repetition: " + repeated.text + " at " +
                                  place_of(repeated.address));
        } else {  // one unit has at least one byte; of stosq and movsq it has eight
          const std::int64_t bytes = value_of(entry->at_most, limits_, entry->place);
          path_block.cost +=
              repeated.text.find("sq ") == std::string::npos ? bytes : (bytes + 7) / 8;
        }
      }
      if (block.library.empty()) continue;
      const std::uint64_t call = block.instructions.back().address;
      std::optional<std::int64_t> bytes = block.bytes;
      if (const LoopEntry* entry = bounds_.entry_of_copy(lines_.of(call)); entry && !bytes) {
        bytes = value_of(entry->at_most, limits_, entry->place);
      }
      const LibraryCost cost = library_cost(block.library, bytes);
      if (!cost.refusal.empty()) proof.reasons.push_back(cost.refusal + " at " + place_of(call));
      path_block.cost += cost.instructions;
      declared.insert(block.library);
    }
  }
  proof.declared.assign(declared.begin(), declared.end());
}

void Prover::add_loops(const CallGraph& calls, const KernelCounts& kernel,
                       KernelProof& proof) const {
  std::map<const LoopEntry*, PathTotal> totals;
  std::map<std::pair<const LoopEntry*, int>, PathTotal> together;  // by the outermost header
  int first = 0;
  for (const FunctionGraph& function : calls.functions) {
    std::vector<LoopMatch> matches;
    for (const Loop& loop : function.loops) {
      matches.push_back(bounds_.match(function, loop, lines_));
    }
    for (std::size_t i = 0; i < function.loops.size(); ++i) {
      const Loop& loop = function.loops[i];
      const Block& header = function.blocks[static_cast<std::size_t>(loop.header)];
      const Block& latch = function.blocks[static_cast<std::size_t>(loop.latches.front())];
      const LoopEntry* entry = matches[i].entry;
      LoopFinding finding{header.address, "", code_.text_of(header.address), loop.counted};
      bool is_shared = false;  // its entry is that of a loop around it or inside it, too
      for (std::size_t other = 0; other < function.loops.size(); ++other) {
        if (other == i || entry == nullptr || matches[other].entry != entry) continue;
        is_shared = is_shared || is_around(function, other, i) || is_around(function, i, other);
      }
      if (loop.counted && (entry == nullptr || is_shared)) {
        finding.place = place_text(lines_.of(latch.instructions.back().address));
        proof.graph.loops.push_back({first + loop.header, *loop.counted});
        proof.loops.push_back(finding);
        continue;
      }
      if (entry == nullptr) {
        finding.place = place_text(lines_.of(latch.instructions.back().address));
        const LoopEntry* near = matches[i].near;
        proof.reasons.push_back(
            "a loop without a maximum at " + place_of(latch.instructions.back().address) +
            (near == nullptr
                 ? ""
                 : "; " + near->line_text() + " does not contain " + place_of(matches[i].outside)));
        proof.loops.push_back(finding);
        continue;
      }
      std::size_t outermost = i;  // of the loops around with the same entry
      for (int around = loop.parent; around >= 0;
           around = function.loops[static_cast<std::size_t>(around)].parent) {
        const auto outer = static_cast<std::size_t>(around);
        if (matches[outer].entry == entry && !function.loops[outer].counted) outermost = outer;
      }
      if (outermost != i && !entry->each && !entry->together) {
        proof.reasons.push_back("two nested loops of " + entry->line_text() + " at " +
                                place_of(header.address));
      }
      if (entry->together) {
        PathTotal& all = together[{entry, first + function.loops[outermost].header}];
        all.scope = first + function.loops[outermost].header;
        all.at_most = value_of(entry->at_most, limits_, entry->place);
        all.blocks.push_back(first + loop.header);
      }
      finding.place = entry->line_text();
      const auto lower = [&](std::int64_t at_most) {
        finding.at_most = std::min(finding.at_most.value_or(at_most), at_most);
      };
      const auto total = entry->total.find(kernel.kernel);
      if (total != entry->total.end()) {
        PathTotal& all = totals[entry];
        all.at_most = value_of(total->second, kernel.worst, entry->place);
        all.blocks.push_back(first + loop.header);
        lower(all.at_most);
      }
      if (!entry->at_most.empty()) {
        lower(value_of(entry->at_most, limits_, entry->place));
      } else if (!finding.at_most) {
        proof.reasons.push_back(entry->place + ": no maximum for " + kernel.kernel);
      }
      if (finding.at_most) proof.graph.loops.push_back({first + loop.header, *finding.at_most});
      proof.loops.push_back(finding);
      for (int around = loop.parent; around >= 0 && !entry->per.empty();
           around = function.loops[static_cast<std::size_t>(around)].parent) {
        const auto outer = static_cast<std::size_t>(around);
        if (matches[outer].entry == nullptr || matches[outer].entry->line_text() != entry->per) {
          continue;
        }
        proof.graph.totals.push_back({{first + loop.header},
                                      value_of(entry->in_each, limits_, entry->place),
                                      PathTotal::Of::jumps_back,
                                      first + function.loops[outer].header});
        break;
      }
    }
    first += static_cast<int>(function.blocks.size());
  }
  for (const auto& [entry, total] : totals) proof.graph.totals.push_back(total);
  for (const auto& [entry, total] : together) proof.graph.totals.push_back(total);
}

void Prover::add_calls(const CallGraph& calls, const KernelCounts& kernel,
                       KernelProof& proof) const {
  std::map<const LoopEntry*, PathTotal> totals;
  int number = 0;
  for (const FunctionGraph& function : calls.functions) {
    for (const Block& block : function.blocks) {
      const int here = number++;
      if (!block.callee && block.library.empty()) continue;
      const LoopEntry* entry = bounds_.entry_of_call(lines_.of(block.instructions.back().address));
      if (entry == nullptr) continue;
      const auto total = entry->total.find(kernel.kernel);
      if (total == entry->total.end()) continue;
      PathTotal& all = totals[entry];
      all.of = PathTotal::Of::runs;
      all.at_most = value_of(total->second, kernel.worst, entry->place);
      all.blocks.push_back(here);
    }
  }
  for (const auto& [entry, total] : totals) proof.graph.totals.push_back(total);
}

void Prover::find_heaviest(const PathSolution& solution, KernelProof& proof) const {
  constexpr std::size_t k_blocks_listed = 12;
  for (std::size_t i = 0; i < proof.graph.blocks.size(); ++i) {
    const PathBlock& block = proof.graph.blocks[i];
    const double instructions = solution.runs[i] * static_cast<double>(block.cost);
    if (instructions < 0.5) continue;
    proof.heaviest.push_back(
        {block.address, code_.text_of(block.address), block.place, solution.runs[i], instructions});
  }
  std::stable_sort(
      proof.heaviest.begin(), proof.heaviest.end(),
      [](const HeavyBlock& a, const HeavyBlock& b) { return a.instructions > b.instructions; });
  if (proof.heaviest.size() > k_blocks_listed) proof.heaviest.resize(k_blocks_listed);
}

KernelProof Prover::prove(const KernelCounts& kernel, const std::string& folder) const {
  KernelProof proof;
  proof.kernel = kernel.kernel;
  const auto names = bounds_.kernels().find(kernel.kernel);
  if (names == bounds_.kernels().end()) {
    proof.reasons.emplace_back("no function is declared for this kernel");
    return proof;
  }
  const FunctionSymbol* root = root_of(code_, names->second, proof.reasons);
  if (root == nullptr) return proof;
  proof.function = short_name(root->name);
  proof.root = root->name;
  const CallGraph calls = call_graph(code_, root->address);
  for (const FunctionGraph& function : calls.functions) {
    for (const Refusal& refusal : function.refusals) {
      proof.reasons.push_back(refusal.what + " at " + place_of(refusal.address));
    }
  }
  for (const Refusal& refusal : calls.refusals) {
    proof.reasons.push_back(refusal.what + " at " + place_of(refusal.address));
  }
  proof.graph = path_graph_of(code_, calls);
  proof.graph.kernel = kernel.kernel;
  for (PathBlock& block : proof.graph.blocks) block.place = place_text(lines_.of(block.address));
  check_same_code(calls, proof);
  add_library_costs(calls, proof);
  add_loops(calls, kernel, proof);
  add_calls(calls, kernel, proof);
  if (!proof.reasons.empty()) return proof;

  const PathSolution solution = solve(proof.graph, folder);
  try {
    proof.certificate = certificate_of(proof.graph, solution);
  } catch (const std::runtime_error& error) {
    proof.reasons.push_back(std::string("no certificate: ") + error.what());
    return proof;
  }
  const double above = static_cast<double>(proof.certificate.bound) - solution.longest;
  proof.tight = solution.whole && above < 0.5 && above > -0.5;
  find_heaviest(solution, proof);
  proof.graph_text = text_of(proof.graph);
  proof.certificate_text = text_of(proof.certificate, hash_of(proof.graph_text));
  return proof;
}

}  // namespace glint::prove
