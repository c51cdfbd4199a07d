// Field numbers: Perfetto, protos/perfetto/trace/{trace_packet,track_event/track_event,
// track_event/track_descriptor,track_event/debug_annotation}.proto.
#include <algorithm>
#include <set>
#include <vector>

#include "platform/budget/export/protobuf_writer.hpp"
#include "platform/budget/export/trace_export.hpp"

namespace glint {
namespace {

// Trace
constexpr std::uint32_t k_packet = 1;
// TracePacket
constexpr std::uint32_t k_timestamp = 8, k_sequence = 10, k_track_event = 11, k_sequence_flags = 13,
                        k_track_descriptor = 60;
constexpr std::uint64_t k_state_cleared = 1;
// TrackDescriptor, ProcessDescriptor
constexpr std::uint32_t k_track_uuid = 1, k_track_name = 2, k_track_process = 3, k_track_parent = 5;
constexpr std::uint32_t k_pid = 1, k_process_name = 6;
// TrackEvent, DebugAnnotation
constexpr std::uint32_t k_annotation = 4, k_type = 9, k_event_track = 11, k_category = 22,
                        k_name = 23;
constexpr std::uint32_t k_annotation_int = 4, k_annotation_name = 10;
constexpr std::uint64_t k_slice_begin = 1, k_slice_end = 2;

constexpr std::uint64_t k_process_track = 1;
constexpr std::uint64_t k_only_sequence = 1;

std::uint64_t track_of(const TraceSpan& span) {
  const std::uint64_t row = (span.flags & k_span_release) != 0 ? 255 : span.worker;
  return 2 + (std::uint64_t{span.group} << 8 | row);
}

void add_packet(ProtobufWriter& trace, ProtobufWriter packet) {
  packet.number(k_sequence, k_only_sequence);
  trace.message(k_packet, packet);
}

void add_track(ProtobufWriter& trace, const TraceFile& file, const TraceSpan& span) {
  ProtobufWriter track, packet;
  track.number(k_track_uuid, track_of(span));
  track.bytes(k_track_name,
              std::string(file.group_name(span)) +
                  ((span.flags & k_span_release) != 0 ? ": released"
                                                      : ": worker " + std::to_string(span.worker)));
  track.number(k_track_parent, k_process_track);
  packet.message(k_track_descriptor, track);
  add_packet(trace, packet);
}

void annotate(ProtobufWriter& event, std::string_view name, std::int64_t value) {
  ProtobufWriter annotation;
  annotation.number(k_annotation_int, static_cast<std::uint64_t>(value));
  annotation.bytes(k_annotation_name, name);
  event.message(k_annotation, annotation);
}

struct Edge {
  std::int64_t time_ns;
  bool begins;
  const TraceSpan* span;
};

// Perfetto requires each track's slices in order and properly nested: an end before the next begin.
std::vector<Edge> edges_of(const TraceFile& file) {
  std::vector<Edge> edges;
  for (const TraceSpan& span : file.spans) {
    edges.push_back({span.begin_ns, true, &span});
    edges.push_back({span.end_ns, false, &span});
  }
  // Order at equal times: ends, then both edges of empty spans, then begins.
  const auto order = [](const Edge& edge) {
    if (edge.span->begin_ns == edge.span->end_ns) return 1;
    return edge.begins ? 2 : 0;
  };
  std::stable_sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) {
    return a.time_ns != b.time_ns ? a.time_ns < b.time_ns : order(a) < order(b);
  });
  return edges;
}

}  // namespace

std::string perfetto_trace(const TraceFile& file) {
  ProtobufWriter trace;
  ProtobufWriter process, process_track, first;
  process.number(k_pid, 1);
  process.bytes(k_process_name, "glint " + file.cell);
  process_track.number(k_track_uuid, k_process_track);
  process_track.message(k_track_process, process);
  first.message(k_track_descriptor, process_track);
  first.number(k_sequence_flags, k_state_cleared);
  add_packet(trace, first);

  std::set<std::uint64_t> named;
  for (const TraceSpan& span : file.spans) {
    if (named.insert(track_of(span)).second) add_track(trace, file, span);
  }
  for (const Edge& edge : edges_of(file)) {
    ProtobufWriter event, packet;
    event.number(k_type, edge.begins ? k_slice_begin : k_slice_end);
    event.number(k_event_track, track_of(*edge.span));
    if (edge.begins) {
      event.bytes(k_category, file.group_name(*edge.span));
      event.bytes(k_name, file.node_name(*edge.span));
      annotate(event, "activation", static_cast<std::int64_t>(edge.span->activation));
      annotate(event, "frame", edge.span->frame_sequence);
      annotate(event, "bound_ns", edge.span->bound_ns);
      annotate(event, "flags", edge.span->flags);
    }
    packet.number(k_timestamp, static_cast<std::uint64_t>(edge.time_ns));
    packet.message(k_track_event, event);
    add_packet(trace, packet);
  }
  return trace.data();
}

}  // namespace glint
