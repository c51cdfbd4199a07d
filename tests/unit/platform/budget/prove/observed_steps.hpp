// Instructions that a call executes in the toy functions, counted by the processor's single steps:
// independent of the prover and of the emulator.
#pragma once

#include <cstdint>

namespace glint::prove {

using ToyFunction = int (*)(const int* values, int count);

// -1 if the system refuses to trace a child process.
[[nodiscard]] std::int64_t observed_steps(ToyFunction function, const int* values, int count);

}  // namespace glint::prove
