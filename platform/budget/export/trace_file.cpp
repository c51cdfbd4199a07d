#include "platform/budget/export/trace_file.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "platform/input_error.hpp"

namespace glint {
namespace {

static_assert(std::endian::native == std::endian::little, "spans stand as they are in memory");

TraceFile read_header(const std::string& path, const std::string& line) {
  TraceFile trace;
  try {
    const auto header = nlohmann::json::parse(line);
    for (const auto& item : header.at("groups")) {
      TraceGroup group{item.at("name").get<std::string>(),
                       item.at("nodes").get<std::vector<std::string>>(),
                       item.value("cores", std::vector<int>{})};
      group.cores.resize(group.nodes.size(), 0);
      trace.groups.push_back(std::move(group));
    }
    trace.epoch_unix_ns = header.value("epoch_unix_ns", std::int64_t{0});
    trace.board = header.value("board", std::string());
    trace.cell = header.value("cell", std::string());
  } catch (const nlohmann::json::exception&) {
    throw InputError(path +
                     ":1: no header of a trace; expected one line of JSON with \"groups\", " +
                     "each of \"name\", \"nodes\" and \"cores\"");
  }
  return trace;
}

}  // namespace

std::string_view TraceFile::group_name(const TraceSpan& span) const {
  return span.group < groups.size() ? std::string_view(groups[span.group].name) : "?";
}

std::string_view TraceFile::node_name(const TraceSpan& span) const {
  if ((span.flags & k_span_release) != 0) return "release";
  if ((span.flags & k_span_sent) != 0) return "send";
  return groups[span.group].nodes[span.node];
}

TraceFile read_trace(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  if (!file || !std::getline(file, line)) {
    throw InputError(path + ": cannot be read; expected a trace.spans of glint run");
  }
  TraceFile trace = read_header(path, line);
  for (TraceSpan span; file.read(reinterpret_cast<char*>(&span), sizeof span);) {
    const bool known = span.group < trace.groups.size() &&
                       (!is_node(span) || span.node < trace.groups[span.group].nodes.size());
    if (!known || span.end_ns < span.begin_ns) {
      throw InputError(path + ": span " + std::to_string(trace.spans.size()) + " has group " +
                       std::to_string(span.group) + ", node " + std::to_string(span.node) + ", " +
                       std::to_string(span.end_ns - span.begin_ns) +
                       " ns; expected one of the header's nodes that ends after it begins");
    }
    trace.spans.push_back(span);
  }
  return trace;
}

TraceFile around_frame(const TraceFile& trace, std::uint32_t frame) {
  constexpr std::uint8_t frame_group = 0;
  std::int64_t begin = 0, end = -1, sent = -1;
  for (const TraceSpan& span : trace.spans) {
    if (span.frame_sequence != frame) continue;
    if (span.group == frame_group) {
      begin = end < 0 ? span.begin_ns : std::min(begin, span.begin_ns);
      end = std::max(end, span.end_ns);
    } else if ((span.flags & k_span_sent) != 0) {
      sent = sent < 0 ? span.end_ns : std::min(sent, span.end_ns);
    }
  }
  if (end < 0) throw InputError("--frame " + std::to_string(frame) + ": not in the trace");
  TraceFile part = trace;
  std::erase_if(part.spans, [&](const TraceSpan& span) {
    return span.end_ns < begin || span.begin_ns > std::max(end, sent);
  });
  return part;
}

void write_trace(const std::string& path, const TraceFile& trace) {
  nlohmann::ordered_json groups = nlohmann::ordered_json::array();
  for (const TraceGroup& group : trace.groups) {
    groups.push_back({{"name", group.name}, {"nodes", group.nodes}, {"cores", group.cores}});
  }
  const nlohmann::ordered_json header{{"groups", groups},
                                      {"epoch_unix_ns", trace.epoch_unix_ns},
                                      {"board", trace.board},
                                      {"cell", trace.cell}};
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file << header.dump() << '\n';
  file.write(reinterpret_cast<const char*>(trace.spans.data()),
             static_cast<std::streamsize>(trace.spans.size() * sizeof(TraceSpan)));
  if (!file.flush())
    throw InputError(path + ": cannot be written; expected a writable folder with free space");
}

}  // namespace glint
