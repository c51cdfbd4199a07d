#include "platform/tools/inspect/recorded_frames.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include "kernels/pose/marker_range.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/pipeline.hpp"
#include "platform/runtime/session/recorded_cell.hpp"
#include "platform/sources/open_source.hpp"

namespace glint {
namespace {

std::string kind_of(const std::string& source, const std::string& stated) {
  if (source.empty() || !stated.empty()) return stated;
  const std::string kind = kind_at(source);
  if (!kind.empty()) return kind;
  if (!std::filesystem::is_directory(source)) return "recording";  // its reader reports the error
  throw InputError(source +
                   ": no recorded frames in this folder; expected frames.csv, .mcap files, or "
                   "\"Depth AHaT.tar\" of StreamRecorder");
}

}  // namespace

Cell recorded_source_cell(const std::string& source, const std::string& config,
                          const std::string& stated, ReadTolerance tolerance) {
  const std::string kind = kind_of(source, stated);
  Cell cell;
  if (kind == "recording" && config.empty() && !source.empty()) {
    RecordingReader reader(source, tolerance);
    cell = recorded_cell(reader, source);
    cell.source = {};
  } else {
    cell = config.empty() ? default_cell() : load_cell(config);
  }
  if (!source.empty()) {
    cell.source.kind = kind;
    cell.source.path = source;
    cell.source.position = (config.empty() ? source : config) + ": source";
  }
  if (cell.source.kind == "simulator") {
    throw InputError(
        "no SOURCE and no [source] in the cell; expected a recording, a bag, a folder with "
        "frames.csv or a headset's capture");
  }
  return cell;
}

RecordedFrames open_recorded(const std::string& path, const std::string& config,
                             const std::string& kind) {
  RecordedFrames recorded;
  recorded.path = path;
  recorded.cell = recorded_source_cell(path, config, kind);
  recorded.source = open_source(recorded.cell);
  return recorded;
}

std::size_t select_tool(Cell& cell, const std::string& name) {
  std::string names;
  for (int t = 0; t < cell.tools.count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    if (name.empty() || name == cell.tools.items[i].name.data()) return i;
    names += std::string(cell.tools.items[i].name.data()) + ", ";
  }
  if (!built_in_tool(name) && std::filesystem::path(name).extension().empty()) {
    throw InputError("--tool " + name + ": unknown tool; expected one of " + names +
                     "a built-in one, or a tool file (.toml, .rom, .ini)");
  }
  set_only_tool(cell, named_tool(name));
  return 0;
}

void set_only_tool(Cell& cell, const Tool& tool) {
  cell.tools = ToolSet{};
  cell.tools.items[0] = tool;
  cell.tools.count = 1;
  cell.reference = -1;
}

TrackedFrames track_frames(RecordedFrames& recorded, Search search,
                           const std::function<void(const ArrivedFrame&, Tracker&)>& visit) {
  const auto tracker = std::make_unique<Tracker>();
  configure(recorded.cell, *tracker);
  ToolSet tools = recorded.cell.tools;
  tracker->latest<ToolSet>().set(tools, 1, 0);
  TrackedFrames tracked;
  FrameSource& source = *recorded.source;
  source.start({});
  ArrivedFrame arrived;
  while (source.wait(arrived)) {
    ++tracked.frames;
    if (search == Search::everywhere) {
      // A tool with a new identity is searched everywhere.
      for (Tool& tool : tools.items) tool.identity = static_cast<std::uint32_t>(tracked.frames);
      tracker->latest<ToolSet>().set(tools, static_cast<std::uint64_t>(tracked.frames), 0);
    }
    tracker->input<Frame>() = arrived.frame;
    tracker->input<HeadPose>() = arrived.head;
    tracker->activate();
    if (tracker->output<Estimates>().verdict.usable()) visit(arrived, *tracker);
    source.release_pixels(arrived);
  }
  tracked.failures = source.report().failures;
  return tracked;
}

std::vector<Vector3> marker_centres(const Markers& markers, const Tool& tool) {
  std::vector<Vector3> centres;
  for (int i = 0; i < markers.count; ++i) {
    const Marker& marker = markers.items[static_cast<std::size_t>(i)];
    if ((marker.flags & k_marker_no_depth) != 0 || !(marker.surface_range_m > 0)) continue;
    centres.push_back(marker.ray * centre_range_m(marker, tool));
  }
  return centres;
}

}  // namespace glint
