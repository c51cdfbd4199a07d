// Replay of recorded frames through the frame graph, in order and without ticks, for calibration
// and export.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"
#include "platform/runtime/session/frame_source.hpp"
#include "platform/sinks/record/recording_reader.hpp"

namespace glint {

// Returns a cell whose [source] is recorded frames: `source` if given, of this kind or the kind
// found there. Without a cell file, uses the recording's own cell. Throws InputError if there are
// no recorded frames.
[[nodiscard]] Cell recorded_source_cell(const std::string& source, const std::string& config,
                                        const std::string& kind, ReadTolerance tolerance = {});

struct RecordedFrames {
  std::string path;
  Cell cell;  // with the source's lens if the cell names none
  std::unique_ptr<FrameSource> source;
};

// Throws InputError like recorded_source_cell() and open_source().
[[nodiscard]] RecordedFrames open_recorded(const std::string& path, const std::string& config,
                                           const std::string& kind = {});

// Returns the index of the cell's tool with this name; the first if empty. Any other name is a
// built-in tool or a tool file, which replaces the cell's tools. Throws InputError if it is
// neither.
[[nodiscard]] std::size_t select_tool(Cell& cell, const std::string& name);

// Replaces the cell's tools by this one.
void set_only_tool(Cell& cell, const Tool& tool);

enum class Search {
  tracked,    // as in a live run: only around a tracked tool
  everywhere  // each frame completely, as for new tools
};

struct TrackedFrames {
  int frames = 0;
  std::vector<std::string> failures;  // read errors of the source, a line each
};

// Activates the frame graph with each frame and calls `visit` after each accepted one. Reads the
// source once.
TrackedFrames track_frames(RecordedFrames& recorded, Search search,
                           const std::function<void(const ArrivedFrame&, Tracker&)>& visit);

// Returns the centres of all markers with a range, camera frame, m. The offset from surface to
// centre is that of this tool's markers.
[[nodiscard]] std::vector<Vector3> marker_centres(const Markers& markers, const Tool& tool);

}  // namespace glint
