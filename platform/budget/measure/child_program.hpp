// Runs another program so that its memory lies the same in every run.
#pragma once

#include <string>
#include <vector>

namespace glint {

// Starts it with an empty environment, without address randomisation, in `folder`, its output in
// `folder`/`output`. The process id; -1 where no process can be made.
[[nodiscard]] int start_program(const std::vector<std::string>& command, const std::string& folder,
                                const std::string& output);

// Waits for any of the programs started; its process id, and its exit status (127: not found).
struct EndedProgram {
  int process = -1;
  int status = 0;
};
[[nodiscard]] EndedProgram wait_for_program();

}  // namespace glint
