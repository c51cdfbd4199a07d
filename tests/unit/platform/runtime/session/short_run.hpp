// Short runs for tests: simulated order, no DDS, output in a temporary folder.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "platform/runtime/session/simulated_run.hpp"
#include "platform/sources/scenario_of.hpp"

namespace glint {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "glint-XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::string path() const { return path_; }

 private:
  std::string path_;
};

// Sets the duration, nominal release order and one worker; keeps the rest of the cell.
inline Cell shortened(Cell cell, double seconds) {
  cell.realtime = false;
  cell.workers = 1;
  cell.simulator.duration_s = seconds;
  return cell;
}

inline Cell short_cell(double seconds, const std::string& level = "roi") {
  Cell cell = shortened(default_cell(), seconds);
  cell.record.level = level;
  return cell;
}

inline SessionResult short_run(const Cell& cell, const sim::Scenario& scenario,
                               const std::string& folder) {
  SessionOptions options;
  options.out = folder;
  return run_simulated(cell, scenario, options);
}

inline SessionResult short_run(const Cell& cell, const std::string& folder) {
  return short_run(cell, scenario_of(cell), folder);
}

}  // namespace glint
