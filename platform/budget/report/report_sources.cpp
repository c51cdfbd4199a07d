#include "platform/budget/report/report_sources.hpp"

#include <filesystem>
#include <fstream>

#include "platform/input_error.hpp"
#include "platform/sinks/record/sha256.hpp"

namespace glint {
namespace {

std::string sha256_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Sha256 hash;
  std::vector<std::uint8_t> part(1 << 16);
  while (file) {
    file.read(reinterpret_cast<char*>(part.data()), static_cast<std::streamsize>(part.size()));
    hash.add({part.data(), static_cast<std::size_t>(file.gcount())});
  }
  return hash.hex();
}

// Rejects a file of another glint command, which lacks this key.
void expect_key(const JsonView& view, const char* key, const char* command) {
  if (view.has(key)) return;
  throw InputError(view.file() + ": no \"" + key + "\"; expected what " + command + " wrote");
}

}  // namespace

bool ReportSources::run_was_live() const {
  return summary && summary->text_or("frame_to_can_kind", "observed") == "observed";
}

double ReportSources::observed_frame_to_can_us() const {
  if (!run_was_live() || !summary->has("frame_to_can_us")) return -1;
  return summary->at("frame_to_can_us").number("max");
}

double ReportSources::bound_frame_to_can_us() const {
  if (summary && summary->has("budget") && summary->at("budget").has("bound_us")) {
    const double bound = summary->at("budget").at("bound_us").number_or("frame_to_can", -1);
    if (bound > 0) return bound;
  }
  if (!check) return -1;
  for (const JsonView& chain : check->list("chains")) {
    if (chain.text("name") == "frame_to_can") return chain.number("bound_us");
  }
  return -1;
}

std::vector<std::string> ReportSources::best_effort() const {
  std::vector<std::string> reasons;
  if (!summary) return reasons;
  if (summary->has("budget")) {
    for (const JsonView& item : summary->at("budget").list("best_effort")) {
      reasons.push_back(item.as_text());
    }
  }
  if (reasons.empty()) {
    for (const JsonView& item : summary->list("refused")) reasons.push_back(item.as_text());
  }
  return reasons;
}

ReportSources read_sources(const ReportPaths& paths) {
  ReportSources sources;
  const auto take = [&](const std::string& path, const char* what) {
    sources.inputs.push_back({path, what, sha256_of_file(path)});
  };
  for (const std::string& path : paths.measures) {
    sources.measures.push_back(JsonView::of_file(path));
    expect_key(sources.measures.back(), "kernels", "glint budget measure --json");
    take(path, "costs and their envelope");
  }
  if (!paths.check.empty()) {
    sources.check = JsonView::of_file(paths.check);
    expect_key(*sources.check, "chains", "glint budget check --json");
    take(paths.check, "plan, response times, chains");
  }
  if (!paths.run_folder.empty()) {
    sources.run_folder = paths.run_folder;
    const auto folder = std::filesystem::path(paths.run_folder);
    const std::string summary = (folder / "summary.json").string();
    const std::string trace = (folder / "trace.spans").string();
    if (std::filesystem::exists(summary)) {
      sources.summary = JsonView::of_file(summary);
      take(summary, "the run's summary");
    }
    if (std::filesystem::exists(trace)) {
      sources.trace = read_trace(trace);
      sources.run = observe(*sources.trace);
      take(trace, "every span of the run");
    }
    if (!sources.summary && !sources.trace) {
      throw InputError(
          paths.run_folder +
          ": neither summary.json nor trace.spans; expected a folder of glint run --out");
    }
  }
  if (!paths.footprint.empty()) {
    sources.footprint = JsonView::of_file(paths.footprint);
    expect_key(*sources.footprint, "nodes", "the footprint check");
    take(paths.footprint, "memory, stack and code");
  }
  if (sources.inputs.empty()) {
    throw InputError("no input; expected --measure, --check, --run or --footprint");
  }
  return sources;
}

}  // namespace glint
