// glint track FOLDER: each recording of a folder by itself, into a folder of its own below --out.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "platform/shards/sharded_work.hpp"

namespace glint {

inline constexpr const char* k_summary_file = "summary.json";

// Returns the names of the recordings in a folder, sorted; empty if `source` is a recording itself,
// or if its kind is stated.
[[nodiscard]] std::vector<std::string> recordings_below(const std::string& source,
                                                        const std::string& kind);

struct FolderTracking {
  std::vector<std::string> names;
  std::string out, json;
};

// Each recording is a piece of the work. A folder with a recording's name is complete: a recording
// is tracked into NAME.unfinished, which is renamed at its end and removed at its next begin. A
// recording that cannot be tracked is a row with its reason. Returns the exit code: that of a
// shard, or the largest of all recordings. Throws InputError if a signal stops the command.
[[nodiscard]] int track_folder(
    const FolderTracking& folder,
    const std::function<int(const std::string& name, const std::string& out)>& track_one,
    ShardedWork& work);

}  // namespace glint
