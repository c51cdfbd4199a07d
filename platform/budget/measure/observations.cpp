#include "platform/budget/measure/observations.hpp"

#include <stdlib.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <sstream>

#include "platform/budget/measure/child_program.hpp"
#include "platform/cells/toml_reader.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

class MeasuringFolder {
 public:
  MeasuringFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "glint-measure-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw InputError(name + ": cannot be made");
    path_ = name;
  }
  ~MeasuringFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  MeasuringFolder(const MeasuringFolder&) = delete;
  MeasuringFolder& operator=(const MeasuringFolder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

class MeasuringRun {
 public:
  explicit MeasuringRun(const MeasureRequest& request) : request_(request) {
    if (!std::filesystem::exists(request.program)) {
      throw MissingDevice(request.program + ": no measuring program; expected glint_measure" +
                          " (--measure-program FILE)");
    }
  }

  Observations run(const std::function<void(int, int)>& progress) {
    Observations all;
    const std::vector<std::string> names = list(all.build);
    std::vector<std::string> own;  // those of this shard
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (request_.piece.computes(static_cast<int>(i))) own.push_back(names[i]);
    }
    std::map<int, std::string> running;
    std::size_t next = 0;
    int done = 0;
    while (next < own.size() || !running.empty()) {
      while (next < own.size() && static_cast<int>(running.size()) < request_.jobs) {
        running[start(command_for(own[next]), own[next])] = own[next];
        ++next;
      }
      const EndedProgram ended = wait_for_program();
      const auto which = running.find(ended.process);
      if (which == running.end()) continue;
      check(ended.status, which->second);
      running.erase(which);
      progress(++done, static_cast<int>(own.size()));
    }
    for (const std::string& name : names) {
      const Observations one = request_.piece([&] {
        return Observations{all.build, {read(name)}};
      });
      if (one.kernels.empty()) continue;
      if (one.build != all.build) {
        throw InputError(name + ": measured in build \"" + one.build + "\"; expected " +
                         request_.program + " of build \"" + all.build + "\"");
      }
      all.kernels.push_back(one.kernels.front());
    }
    return all;
  }

 private:
  [[nodiscard]] std::vector<std::string> emulated(bool counted, const std::string& name) const {
    std::vector<std::string> command;
    if (request_.emulator.empty()) return command;
    command = {request_.emulator, "-cpu", request_.cpu_model};
    if (counted) {
      command.insert(command.end(), {"-plugin", request_.plugin + ",out=" + name + ".counts"});
    }
    return command;
  }
  [[nodiscard]] std::vector<std::string> command_for(const std::string& kernel) const {
    std::vector<std::string> command = emulated(request_.count_instructions, kernel);
    command.insert(command.end(), {request_.program, "--kernel", kernel, "--inputs",
                                   std::to_string(request_.inputs), "--out", kernel + ".txt",
                                   "--counter", request_.count_instructions ? "marks" : "time",
                                   "--cache", request_.cache, "--interference", request_.load});
    return command;
  }
  int start(const std::vector<std::string>& command, const std::string& name) const {
    const int process = start_program(command, folder_.path(), name + ".output");
    if (process < 0) throw MissingDevice("cannot start a process to measure " + name);
    return process;
  }
  void check(int status, const std::string& name) const {
    if (status == 0) return;
    if (status == 127 && !request_.emulator.empty()) {
      throw MissingDevice(request_.emulator + " is not installed (Debian package qemu-user)");
    }
    throw InputError(request_.program + ": measuring " + name + " ended with " +
                     std::to_string(status) + ": " +
                     first_line(read_text(folder_.path() + "/" + name + ".output")));
  }
  std::vector<std::string> list(std::string& build) const {
    std::vector<std::string> command = emulated(false, "");
    command.insert(command.end(), {request_.program, "--list"});
    const int process = start(command, "list");
    EndedProgram ended;
    do {
      ended = wait_for_program();
    } while (ended.process != process && ended.process >= 0);
    check(ended.status, "list");
    std::istringstream lines(read_text(folder_.path() + "/list.output"));
    std::getline(lines, build);
    std::vector<std::string> names;
    std::string known;
    for (std::string line; std::getline(lines, line);) {
      known += (known.empty() ? "" : ", ") + line;
      if (request_.kernel.empty() || request_.kernel == line) names.push_back(line);
    }
    if (names.empty()) {
      throw InputError("--kernel is \"" + request_.kernel + "\"; expected one of " + known);
    }
    return names;
  }
  [[nodiscard]] KernelObservations read(const std::string& name) const {
    const std::string file = folder_.path() + "/" + name + ".txt";
    std::vector<std::uint64_t> counted;
    if (request_.count_instructions) {
      const std::string bytes = read_text(folder_.path() + "/" + name + ".counts");
      counted.resize(bytes.size() / sizeof(std::uint64_t));
      std::memcpy(counted.data(), bytes.data(), counted.size() * sizeof(std::uint64_t));
      if (counted.empty())
        throw InputError(name + ": no counts; expected markers in " + request_.program);
    }
    return parse_observations(name, file, read_text(file), counted);
  }

  const MeasureRequest& request_;
  MeasuringFolder folder_;
};

void keep_minimum(KernelObservations& kept, const KernelObservations& pass) {
  if (kept.calls.size() != pass.calls.size()) {
    throw InputError(kept.name + ": " + std::to_string(pass.calls.size()) +
                     " calls in a pass; expected " + std::to_string(kept.calls.size()));
  }
  for (std::size_t i = 0; i < kept.calls.size(); ++i) {
    if (kept.calls[i].call.counts != pass.calls[i].call.counts) {
      throw InputError(kept.name + ": call " + std::to_string(i) +
                       " has other loop counts in a pass; expected equal work in each pass");
    }
    kept.calls[i].call.cost = std::min(kept.calls[i].call.cost, pass.calls[i].call.cost);
  }
}

}  // namespace

void keep_minimum(Observations& kept, const Observations& pass) {
  if (kept.kernels.size() != pass.kernels.size()) {
    throw InputError(std::to_string(pass.kernels.size()) + " kernels in a pass; expected " +
                     std::to_string(kept.kernels.size()));
  }
  for (std::size_t i = 0; i < kept.kernels.size(); ++i) {
    keep_minimum(kept.kernels[i], pass.kernels[i]);
  }
}

Observations measure(const MeasureRequest& request, const std::function<void(int, int)>& progress) {
  return MeasuringRun(request).run(progress);
}

}  // namespace glint
