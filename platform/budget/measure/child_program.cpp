#include "platform/budget/measure/child_program.hpp"

#include <fcntl.h>
#include <sys/personality.h>
#include <sys/wait.h>
#include <unistd.h>

namespace glint {

int start_program(const std::vector<std::string>& command, const std::string& folder,
                  const std::string& output) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const std::string file = folder + "/" + output;
  const int process = fork();
  if (process != 0) return process;
  const int out = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (out < 0 || chdir(folder.c_str()) != 0) _exit(126);
  dup2(out, STDOUT_FILENO);
  dup2(out, STDERR_FILENO);
  (void)personality(ADDR_NO_RANDOMIZE);  // refused in some containers; counts still repeat
  char* no_environment[] = {nullptr};
  execvpe(arguments[0], arguments.data(), no_environment);
  _exit(127);
}

EndedProgram wait_for_program() {
  int status = 0;
  const int process = waitpid(-1, &status, 0);
  if (process < 0) return {};
  return {process, WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status)};
}

}  // namespace glint
