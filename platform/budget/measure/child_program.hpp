// Runs another program with the same memory layout in every run.
#pragma once

#include <string>
#include <vector>

namespace glint {

// Starts it in `folder` with an empty environment, without address randomisation, with its output
// in `folder`/`output`. Returns the process id; -1 if no process can be created.
[[nodiscard]] int start_program(const std::vector<std::string>& command, const std::string& folder,
                                const std::string& output);

// Waits for any of the started programs. Returns its process id and exit status (127: not found).
struct EndedProgram {
  int process = -1;
  int status = 0;
};
[[nodiscard]] EndedProgram wait_for_program();

}  // namespace glint
