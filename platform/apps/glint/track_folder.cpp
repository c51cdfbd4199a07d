#include "platform/apps/glint/track_folder.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "platform/apps/glint/output_file.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/read_file.hpp"
#include "platform/sources/open_source.hpp"
#include "platform/stop_signals.hpp"

namespace glint {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct TrackedRecording {
  std::string name;
  int exit_code = 0;
  std::string failure;  // why it was not tracked
  std::string figures;  // JSON: those that repeat exactly; empty after a failure
};

std::string repeatable_figures(const std::string& summary_file) {
  const Json summary = Json::parse(read_file(summary_file, k_text_bytes_max, "a run's figures"));
  Json figures;
  for (const char* key : {"frames", "frames_tracked", "frames_refused", "ticks", "output",
                          "can_frames", "can_sent", "can_dropped", "output_sha256"}) {
    figures[key] = summary.at(key);
  }
  return figures.dump();
}

void rename_folder(const std::string& from, const std::string& to) {
  std::error_code error;
  fs::remove_all(to, error);
  if (!error) fs::rename(from, to, error);
  if (error) throw InputError(to + ": " + error.message() + "; expected a writable folder");
}

void print_recordings(const std::vector<TrackedRecording>& all) {
  std::size_t width = 9;
  for (const TrackedRecording& one : all) width = std::max(width, one.name.size());
  std::printf("%-*s %10s %12s  %s\n", static_cast<int>(width), "recording", "frames", "with a pose",
              "output_sha256");
  for (const TrackedRecording& one : all) {
    const std::string name = printable(one.name);
    if (one.figures.empty()) {
      std::printf("%-*s not tracked: %s\n", static_cast<int>(width), name.c_str(),
                  printable(one.failure).c_str());
      continue;
    }
    const Json figures = Json::parse(one.figures);
    std::printf("%-*s %10lld %12lld  %.16s%s\n", static_cast<int>(width), name.c_str(),
                static_cast<long long>(figures["frames"].get<std::int64_t>()),
                static_cast<long long>(figures["frames_tracked"].get<std::int64_t>()),
                figures["output_sha256"].get<std::string>().c_str(),
                one.exit_code == 0 ? "" : "  FAILED");
  }
}

Json recordings_json(const std::vector<TrackedRecording>& all) {
  Json recordings = Json::array();
  for (const TrackedRecording& one : all) {
    Json row = {{"recording", one.name}, {"exit_code", one.exit_code}};
    if (one.figures.empty()) {
      row["failure"] = one.failure;
    } else {
      row.update(Json::parse(one.figures));
    }
    recordings.push_back(row);
  }
  return {{"recordings", recordings}};
}

}  // namespace

std::vector<std::string> recordings_below(const std::string& source, const std::string& kind) {
  if (!kind.empty() || !fs::is_directory(source)) return {};
  // A folder of MCAP files is a bag by its kind, unless one of them is Glint's own.
  const std::string own_kind = kind_at(source);
  const bool may_be_bag = own_kind == "rosbag" && !fs::exists(source + "/metadata.yaml");
  if (!own_kind.empty() && !may_be_bag) return {};
  std::vector<std::string> names;
  bool has_own = false;
  for (const fs::directory_entry& entry : fs::directory_iterator(source)) {
    const std::string of_entry = kind_at(entry.path().string());
    has_own = has_own || of_entry == "recording";
    if (!of_entry.empty()) names.push_back(entry.path().filename().string());
  }
  if (may_be_bag && !has_own) return {};
  std::sort(names.begin(), names.end());
  return names;
}

int track_folder(
    const FolderTracking& folder,
    const std::function<int(const std::string& name, const std::string& out)>& track_one,
    ShardedWork& work) {
  std::vector<TrackedRecording> all;
  for (const std::string& name : folder.names) {
    all.push_back(work.piece([&] {
      const std::string out = folder.out + "/" + name, unfinished = out + ".unfinished";
      TrackedRecording one{name, 0, {}, {}};
      std::error_code ignored;
      fs::remove_all(unfinished, ignored);
      try {
        one.exit_code = track_one(name, unfinished);
        one.figures = repeatable_figures(unfinished + "/" + k_summary_file);
      } catch (const InputError& error) {
        one.exit_code = 2;
        one.failure = error.what();
      }
      if (stop_on_signals())
        throw InputError(name + ": stopped by a signal; expected the recording's end");
      if (one.figures.empty()) {
        fs::remove_all(unfinished, ignored);
      } else {
        rename_folder(unfinished, out);
      }
      return one;
    }));
  }
  if (work.finish()) return 0;
  print_recordings(all);
  write_json(folder.json, recordings_json(all));
  int exit_code = 0;
  for (const TrackedRecording& one : all) exit_code = std::max(exit_code, one.exit_code);
  return exit_code;
}

}  // namespace glint
