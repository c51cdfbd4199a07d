// Runs of field devices that are done, in a file: an experiment of hours goes on where it ended.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "platform/lab/experiments/field_experiment.hpp"

namespace glint {

// One run: of a device and a random seed.
struct FieldRun {
  FieldDevice device = FieldDevice::drawn;
  std::uint64_t seed = 0;
  double duration_s = 0;
  std::uint64_t ticks = 0;
  std::int64_t trackable = 0, fresh = 0, gross_fits = 0;
  OutputErrors measured, predicted;
};

// A line a run, which begins with the line's end before it: one that is cut short is skipped, and
// its run is done again.
class FinishedRuns {
 public:
  explicit FinishedRuns(const std::string& path);
  // Null: not done yet.
  [[nodiscard]] const FieldRun* find(FieldDevice device, std::uint64_t seed,
                                     double duration_s) const;
  // To the file's end. Throws InputError: it cannot be written.
  const FieldRun& add(const FieldRun& run);

 private:
  std::string path_;
  std::deque<FieldRun> runs_;
};

}  // namespace glint
