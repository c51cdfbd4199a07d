#include "tests/unit/platform/budget/report/sample_files.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "platform/budget/report/run_observations.hpp"
#include "platform/tools/report/statistics.hpp"

namespace glint {
namespace {

using nlohmann::ordered_json;

struct SampleKernel {
  const char* name;
  double bound, largest;
  std::vector<std::pair<const char*, std::pair<int, int>>> loops;  // declared, observed
};

const std::vector<SampleKernel>& sample_kernels() {
  static const std::vector<SampleKernel> kernels = {
      {"RoiThreshold", 131072, 118034, {{"call", {1, 1}}, {"pixels", {65536, 65536}}}},
      {"FindBlobs",
       402113,
       351760,
       {{"call", {1, 1}}, {"runs", {32768, 32768}}, {"pixels", {262144, 262144}}}},
      {"BackProject", 61440, 53980, {{"call", {1, 1}}, {"blobs", {64, 64}}}},
      {"Correspond", 221184, 170142, {{"call", {1, 1}}, {"pairs", {4096, 3712}}}},
      {"RefinePose", 48830, 44391, {{"call", {1, 1}}, {"sweeps", {12, 9}}}},
      {"PackCan", 1840, 1772, {{"call", {1, 1}}, {"tools", {16, 16}}}}};
  return kernels;
}

ordered_json measurement(bool time) {
  ordered_json kernels = ordered_json::array();
  for (const SampleKernel& kernel : sample_kernels()) {
    const double scale = time ? 0.25 : 1;
    ordered_json loops = ordered_json::array();
    for (const auto& [name, counts] : kernel.loops) {
      loops.push_back(
          {{"name", name}, {"declared", counts.first}, {"observed", counts.second}, {"cost", 1.5}});
    }
    ordered_json item{{"name", kernel.name},
                      {"bound", kernel.bound * scale},
                      {"observed_max", kernel.largest * scale},
                      {"inputs", 10000},
                      {"worst_input", {{"kind", "worst"}, {"number", 3}}},
                      {"ratio", kernel.bound / kernel.largest},
                      {"fit_half", {{"inputs", 5000}, {"above", 0}}},
                      {"judge_half", {{"inputs", 5000}, {"above", 0}, {"worst_excess_percent", 0}}},
                      {"loops", loops},
                      {"percentiles",
                       {{"p50", 0.2 * kernel.largest * scale},
                        {"p99", 0.8 * kernel.largest * scale},
                        {"p99_9", 0.95 * kernel.largest * scale},
                        {"max", kernel.largest * scale}}}};
    if (time) {
      ordered_json counts = ordered_json::array();
      for (int bin = 0; bin < 40; ++bin) counts.push_back(std::max(0, 400 - (bin - 8) * (bin - 8)));
      item["histogram"] = {{"low", 0}, {"width", kernel.largest * scale / 40}, {"counts", counts}};
    }
    kernels.push_back(item);
  }
  ordered_json file{{"board", "sample-x86-64"},
                    {"build", "Release -O3"},
                    {"count", time ? "time" : "instructions"},
                    {"unit", time ? "ns" : "instructions"},
                    {"arch", "x86-64"},
                    {"cache", "warm"},
                    {"compiler", "g++ 12.2.0"},
                    {"commit_or_version", "0.1.0"},
                    {"kernels", kernels},
                    {"interference", ordered_json::array()}};
  if (time) {
    file["interference"] = {{{"load", "cache"}, {"kernel", "FindBlobs"}, {"factor", 1.31}},
                            {{"load", "bandwidth"}, {"kernel", "FindBlobs"}, {"factor", 1.72}},
                            {{"enemy", "other_core"}, {"kernel", "FindBlobs"}, {"factor", 1.04}}};
  }
  return file;
}

ordered_json group_json(const char* name, int priority, double makespan, double response,
                        double deadline) {
  return {{"name", name},
          {"priority", priority},
          {"makespan_us", makespan},
          {"response_us", response},
          {"deadline_us", deadline},
          {"slack_percent", 100 * (1 - response / deadline)},
          {"blocking_us", 3.2},
          {"jitter_us", 18.0}};
}

ordered_json stage(const char* name, const char* kind, double us) {
  return {{"name", name}, {"kind", kind}, {"us", us}};
}

ordered_json checked(const SampleSettings& settings, const TraceFile& trace) {
  ordered_json nodes = ordered_json::array();
  const double starts[] = {0,     1.1,   3.5,   13.3,  20.5, 20.5, 81.5,
                           139.5, 172.5, 172.5, 243.5, 252,  252,  279};
  const RunObservations run = observe(trace);
  std::size_t i = 0;
  for (std::size_t g = 0; g < trace.groups.size(); ++g) {
    for (std::size_t n = 0; n < trace.groups[g].nodes.size(); ++n, ++i) {
      const std::string& full = trace.groups[g].nodes[n];
      const auto mark = full.find('#');
      nodes.push_back({{"group", trace.groups[g].name},
                       {"name", full.substr(0, mark)},
                       {"copy", mark == std::string::npos ? 0 : full[mark + 1] - '0'},
                       {"core", trace.groups[g].cores[n]},
                       {"start_us", g == 0 ? starts[n] : 12.0 * static_cast<double>(n)},
                       {"bound_us", run.nodes[i].bound_us},
                       {"slack_percent", 92.1},
                       {"may_grow_percent", 38.0 + 11 * static_cast<double>(n)}});
    }
  }
  const ordered_json stages = {
      stage("frame in memory to wake-up", "estimate", 62),
      stage("frame group's response", "bound", 338), stage("sampling: one tick", "declared", 4000),
      stage("tick group's response", "bound", 33), stage("CAN write", "estimate", 41)};
  const ordered_json sensor_stages = {stage("exposure, from its middle", "declared", 500),
                                      stage("readout and transport", "declared", 3200),
                                      stage("frame group's response", "bound", 338),
                                      stage("sampling: one tick", "declared", 4000),
                                      stage("tick group's response", "bound", 33),
                                      stage("CAN write", "estimate", 41),
                                      stage("CAN queue and transmission", "bound", 466)};
  ordered_json file{
      {"board", "sample-x86-64"},
      {"board_sha256", "9f2b51a6d41c0b7de5a0c1f7b9d3e8846a1a02c55d1b7f3c9a64f0e2d7b81c35"},
      {"plan", "two_cores.plan"},
      {"cores", 2},
      {"limits", {{"width", 512}, {"height", 512}, {"tools", 5}, {"blobs", 64}}},
      {"void", ordered_json::array()},
      {"groups", {group_json("frame", 80, 293, 338, 22222), group_json("tick", 90, 18, 33, 4000)}},
      {"nodes", nodes},
      {"chains",
       {{{"name", "frame_to_can"},
         {"deadline_us", 6000},
         {"bound_us", 4474},
         {"slack_percent", 25.4},
         {"maximum_reaction_time_us", 26696},
         {"maximum_data_age_us", 30696},
         {"jitter_us", 4100},
         {"stages", stages}},
        {{"name", "exposure_to_bus"},
         {"deadline_us", settings.check_fails ? 8000 : 12000},
         {"bound_us", 8578},
         {"slack_percent", settings.check_fails ? -7.2 : 28.5},
         {"maximum_reaction_time_us", 30800},
         {"maximum_data_age_us", 34800},
         {"jitter_us", 4200},
         {"stages", sensor_stages}}}},
      {"can",
       {{{"name", "Status"}, {"identifier", 0x180}, {"response_us", 243}, {"deadline_us", 1000}},
        {{"name", "Position"}, {"identifier", 0x181}, {"response_us", 376}, {"deadline_us", 4000}},
        {{"name", "Rotation"},
         {"identifier", 0x182},
         {"response_us", 466},
         {"deadline_us", 4000}}}},
      {"bus_load", 0.187},
      {"system_slack_percent", 25.4},
      {"break_even_clock", 0.184},
      {"largest", {{"roi_pixels", 262144}, {"tools", 16}}},
      {"estimates", {{"wake_up_us", 62}, {"can_write_us", 41}}},
      {"margin_percent", 10},
      {"verdict", settings.check_fails ? "fails" : "holds"},
      {"fails", ordered_json::array()}};
  if (settings.check_fails) {
    file["fails"] = {
        "chain exposure_to_bus: bound 8578 us is 578 us above its deadline of 8000 us"};
  }
  return file;
}

ordered_json times_json(const std::vector<double>& us) {
  return {{"n", us.size()},
          {"p50", percentile(us, 0.5)},
          {"p99", percentile(us, 0.99)},
          {"p99_9", percentile(us, 0.999)},
          {"max", *std::max_element(us.begin(), us.end())}};
}

ordered_json summary_of(const SampleSettings& settings, const TraceFile& trace) {
  std::vector<double> whole, computing;
  for (const FrameLatency& frame : observe(trace).frames) {
    whole.push_back(frame.us);
    computing.push_back(frame.computing_us);
  }
  ordered_json times = times_json(whole);
  times["computing"] = times_json(computing);
  ordered_json best_effort = ordered_json::array();
  if (settings.best_effort) {
    best_effort = {"SCHED_FIFO was refused: no right to real-time priorities",
                   "cpu0's governor is powersave; expected performance"};
  }
  return {{"cell", "sample.toml"},
          {"frames", settings.frames},
          {"frame_to_can_us", times},
          {"frame_to_can_kind", settings.real_time ? "observed" : "nominal"},
          {"budget",
           {{"board", "sample-x86-64"},
            {"plan", "two_cores.plan"},
            {"bound_us", {{"frame", 338}, {"tick", 33}, {"frame_to_can", 4474}}},
            {"overruns", {{"frame", 0}, {"tick", 0}, {"by_policy", ordered_json::object()}}},
            {"best_effort", best_effort}}}};
}

ordered_json footprint_of(const TraceFile& trace) {
  ordered_json nodes = ordered_json::array();
  int i = 0;
  for (const TraceGroup& group : trace.groups) {
    for (const std::string& node : group.nodes) {
      ++i;
      nodes.push_back({{"name", node},
                       {"state_bytes", 64 * i},
                       {"token_bytes", 512 * i},
                       {"stack_bound_bytes", 480 + 96 * i},
                       {"stack_observed_bytes", 400 + 80 * i},
                       {"code_bytes", 900 + 310 * i}});
    }
  }
  return {{"nodes", nodes}};
}

void write(const std::filesystem::path& path, const ordered_json& content) {
  std::ofstream(path) << content.dump(1) << '\n';
}

}  // namespace

void write_samples(const std::string& folder, const SampleSettings& settings) {
  const std::filesystem::path path(folder);
  std::filesystem::create_directories(path / "run");
  const TraceFile trace = sample_trace(settings);
  write(path / "measure.json", measurement(false));
  write(path / "measure_time.json", measurement(true));
  write(path / "check.json", checked(settings, trace));
  write(path / "footprint.json", footprint_of(trace));
  write(path / "run" / "summary.json", summary_of(settings, trace));
  write_trace((path / "run" / "trace.spans").string(), trace);
}

}  // namespace glint
