// Instruction bounds that a proof states for a program's machine code, as `glint budget check` uses
// them. The file is written by `glint budget prove --json`.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kernels/limits.hpp"

namespace glint {

struct ProvedKernel {
  std::string kernel, root, code_sha256;  // root: demangled name of the function that it covers
  std::int64_t instructions = 0;
};

struct ProofFile {
  std::string machine;  // "x86-64", "arm64"
  Limits limits;
  std::vector<ProvedKernel> kernels;
};

// Throws InputError for a file of another form.
[[nodiscard]] ProofFile load_proofs(const std::string& file);

// Bounds that hold for one program, and why the others do not.
struct ProvedBounds {
  Limits limits;
  std::map<std::string, std::int64_t> instructions;  // by kernel
  std::map<std::string, std::string> refused;
};

[[nodiscard]] nlohmann::ordered_json limits_json(const Limits& limits);

// No field of `smaller` exceeds that of `larger`.
[[nodiscard]] bool covers(const Limits& larger, const Limits& smaller);

}  // namespace glint
