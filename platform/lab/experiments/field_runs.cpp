#include "platform/lab/experiments/field_runs.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "platform/input_error.hpp"

namespace glint {

FinishedRuns::FinishedRuns(const std::string& path) : path_(path) {
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    FieldRun run;
    int device = 0;
    std::string end;
    fields >> device >> run.seed >> run.duration_s >> run.ticks >> run.trackable >> run.fresh >>
        run.gross_fits;
    for (OutputErrors* errors : {&run.measured, &run.predicted})
      fields >> errors->count >> errors->inside_position >> errors->inside_rotation >>
          errors->gross >> errors->square_m2 >> errors->square_rad2 >> errors->stated_m2 >>
          errors->stated_rad2 >> errors->log_score;
    run.device = static_cast<FieldDevice>(device);
    if (fields >> end && end == "end") runs_.push_back(run);
  }
}

const FieldRun* FinishedRuns::find(FieldDevice device, std::uint64_t seed,
                                   double duration_s) const {
  const auto found = std::find_if(runs_.begin(), runs_.end(), [&](const FieldRun& run) {
    return run.device == device && run.seed == seed && run.duration_s == duration_s;
  });
  return found == runs_.end() ? nullptr : &*found;
}

const FieldRun& FinishedRuns::add(const FieldRun& run) {
  std::ofstream out(path_, std::ios::app);
  out.precision(17);
  out << '\n'
      << static_cast<int>(run.device) << ' ' << run.seed << ' ' << run.duration_s << ' '
      << run.ticks << ' ' << run.trackable << ' ' << run.fresh << ' ' << run.gross_fits;
  for (const OutputErrors* errors : {&run.measured, &run.predicted})
    out << ' ' << errors->count << ' ' << errors->inside_position << ' ' << errors->inside_rotation
        << ' ' << errors->gross << ' ' << errors->square_m2 << ' ' << errors->square_rad2 << ' '
        << errors->stated_m2 << ' ' << errors->stated_rad2 << ' ' << errors->log_score;
  out << " end";
  out.flush();
  if (!out) throw InputError(path_ + ": cannot be written; expected free space for a finished run");
  return runs_.emplace_back(run);
}

}  // namespace glint
