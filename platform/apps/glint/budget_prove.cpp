// glint budget prove: instruction bounds of the kernels, computed from a program's machine code.
#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "platform/apps/glint/budget_commands.hpp"
#include "platform/apps/glint/cell_option.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/budget/prove/kernel_counts.hpp"
#include "platform/budget/prove/prove.hpp"
#include "platform/budget/proved_bounds.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"

namespace glint {
namespace {

struct ProveArguments {
  std::string program = "/proc/self/exe", lines, source = ".", out = "out/prove", cell, json;
  std::vector<std::string> kernels;
  bool largest = false, blocks = false, loops = false;
};

nlohmann::ordered_json json_of(const prove::KernelProof& proof) {
  nlohmann::ordered_json json;
  json["kernel"] = proof.kernel;
  json["function"] = proof.function;
  json["root"] = proof.root;
  json["kind"] = proof.proved() ? "proved" : "not proved";
  json["machine"] = proof.graph.machine;
  json["code_sha256"] = proof.graph.code_sha256;
  json["functions"] = proof.graph.functions.size();
  json["declared_library_functions"] = proof.declared;
  json["reasons"] = proof.reasons;
  if (!proof.proved()) return json;
  json["instructions_bound"] = proof.certificate.bound;
  json["path_of_this_cost_exists"] = proof.tight;
  for (const prove::HeavyBlock& block : proof.heaviest) {
    json["heaviest_blocks"].push_back({{"block", block.function},
                                       {"place", block.place},
                                       {"runs", block.runs},
                                       {"instructions", block.instructions}});
  }
  return json;
}

void print_proof(const prove::KernelProof& proof, const ProveArguments& arguments) {
  if (proof.proved()) {
    std::printf("%-14s proved     %12" PRId64 "  %s  %s\n", proof.kernel.c_str(),
                proof.certificate.bound, proof.graph.code_sha256.substr(0, 12).c_str(),
                printable(proof.function).c_str());
  } else {
    std::printf("%-14s not proved %12s  %zu reasons\n", proof.kernel.c_str(), "-",
                proof.reasons.size());
    constexpr std::size_t k_reasons_printed = 60;
    for (std::size_t i = 0; i < std::min(proof.reasons.size(), k_reasons_printed); ++i) {
      std::printf("    %s\n", printable(proof.reasons[i]).c_str());
    }
  }
  for (const prove::LoopFinding& loop : proof.loops) {
    if (!arguments.loops) break;
    std::printf("    loop %-60s %-40s %s\n", printable(loop.function).c_str(),
                printable(loop.place).c_str(),
                loop.at_most ? std::to_string(*loop.at_most).c_str() : "unknown");
  }
  for (const prove::HeavyBlock& block : proof.heaviest) {
    if (!arguments.blocks) break;
    std::printf("    block %12.0f = %10.0f runs  %-50s %s\n", block.instructions, block.runs,
                printable(block.function).c_str(), printable(block.place).c_str());
  }
}

int run_prove(const ProveArguments& arguments) {
  const Limits limits = arguments.largest ? Limits{} : limits_of(cell_or_default(arguments.cell));
  const prove::LoopBounds bounds(arguments.source + "/platform/budget/prove/loops.toml",
                                 arguments.source);
  const prove::Prover prover(arguments.program,
                             arguments.lines.empty() ? arguments.program : arguments.lines, bounds,
                             prove::names_of(limits));
  const std::vector<prove::KernelCounts> kernels = prove::kernel_counts(limits);
  for (const std::string& name : arguments.kernels) {
    const auto is_it = [&](const prove::KernelCounts& one) { return one.kernel == name; };
    if (std::none_of(kernels.begin(), kernels.end(), is_it)) {
      throw InputError("--kernel " + name + ": expected a kernel of the tracker or output graph");
    }
  }
  std::printf("%s, %s: executed instructions of one activation\n",
              printable(arguments.program).c_str(), name_of(prover.code().machine()).c_str());
  nlohmann::ordered_json json;
  json["machine"] = name_of(prover.code().machine());
  json["limits"] = limits_json(limits);
  std::size_t proved = 0, all = 0;
  for (const prove::KernelCounts& kernel : kernels) {
    const auto& wanted = arguments.kernels;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), kernel.kernel) == wanted.end()) {
      continue;
    }
    const std::string folder = arguments.out + "/" + kernel.kernel;
    make_folder(folder);
    const prove::KernelProof proof = prover.prove(kernel, folder);
    if (proof.proved()) {
      write_text(folder + "/path.graph", proof.graph_text);
      write_text(folder + "/path.certificate", proof.certificate_text);
    }
    print_proof(proof, arguments);
    json["kernels"].push_back(json_of(proof));
    proved += proof.proved() ? 1 : 0;
    ++all;
  }
  std::printf("%zu of %zu kernels proved; certificates in %s\n", proved, all,
              printable(arguments.out).c_str());
  write_json(arguments.json, json);
  return proved == all ? 0 : 1;
}

}  // namespace

void add_budget_prove(CLI::App& budget, int& exit_code) {
  CLI::App* command = budget.add_subcommand(
      "prove", "Compute instruction bounds from machine code, with certificates");
  auto arguments = std::make_shared<ProveArguments>();
  command->footer(
      "Example: glint budget prove build/glint_measure --lines build-lines/glint_measure\n"
      "Exit 1: a kernel is not proved; each reason has its function, address and source line.");
  command->add_option("program", arguments->program, "ELF program, x86-64 or arm64")
      ->capture_default_str();
  command->add_option("--lines", arguments->lines,
                      "program of the same machine code with a line table (-g1); default: program");
  command->add_option("--source", arguments->source, "source tree of the program")
      ->capture_default_str();
  command->add_option("--kernel", arguments->kernels, "kernel to prove, repeatable; default: all");
  add_cell_option(*command, arguments->cell);
  command->add_flag("--largest", arguments->largest, "largest limits of the code, for any cell");
  command->add_flag("--blocks", arguments->blocks, "print the blocks that cost most");
  command->add_flag("--loops", arguments->loops, "print each loop's maximum");
  command->add_option("--out", arguments->out, "folder of graphs and certificates")
      ->capture_default_str();
  command->add_option("--json", arguments->json, "file of the table's figures");
  command->callback([arguments, &exit_code] { exit_code = run_prove(*arguments); });
}

}  // namespace glint
