#include <algorithm>
#include <cstdio>
#include <ctime>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "platform/budget/export/trace_export.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

using nlohmann::ordered_json;

double microseconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

// Names in BTF must not contain commas.
std::string btf_name(std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), ',', '_');
  return text;
}

std::string date_of(std::int64_t unix_ns) {
  const std::time_t seconds = static_cast<std::time_t>(unix_ns / 1'000'000'000);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

struct BtfLine {
  std::int64_t time_ns;
  int order;  // at equal times: ends, then begins
  std::string text;
};

// Calls of one activation on one worker: an instance of a BTF task.
struct TaskInstance {
  std::int64_t begin_ns = 0, end_ns = 0;
  int core = 0;
};

}  // namespace

std::string chrome_trace(const TraceFile& trace) {
  ordered_json events = ordered_json::array();
  for (std::size_t group = 0; group < trace.groups.size(); ++group) {
    events.push_back({{"ph", "M"},
                      {"pid", group + 1},
                      {"name", "process_name"},
                      {"args", {{"name", trace.groups[group].name}}}});
  }
  for (const TraceSpan& span : trace.spans) {
    events.push_back({{"ph", "X"},
                      {"name", trace.node_name(span)},
                      {"cat", trace.group_name(span)},
                      {"pid", span.group + 1},
                      {"tid", (span.flags & k_span_release) != 0 ? 255 : span.worker},
                      {"ts", microseconds(span.begin_ns)},
                      {"dur", microseconds(span.end_ns - span.begin_ns)},
                      {"args",
                       {{"activation", span.activation},
                        {"frame", span.frame_sequence},
                        {"bound_us", microseconds(span.bound_ns)},
                        {"overran", (span.flags & k_span_overran) != 0},
                        {"will_miss", (span.flags & k_span_will_miss) != 0},
                        {"injected", (span.flags & k_span_injected) != 0}}}});
  }
  return ordered_json{{"displayTimeUnit", "ns"},
                      {"otherData", {{"board", trace.board}, {"cell", trace.cell}}},
                      {"traceEvents", events}}
             .dump() +
         "\n";
}

std::string csv_trace(const TraceFile& trace) {
  std::string text =
      "group,node,activation,frame,worker,begin_ns,end_ns,duration_ns,bound_ns,overran,will_miss,"
      "injected\n";
  for (const TraceSpan& span : trace.spans) {
    text += btf_name(trace.group_name(span)) + ',' + btf_name(trace.node_name(span)) + ',' +
            std::to_string(span.activation) + ',' + std::to_string(span.frame_sequence) + ',' +
            std::to_string(span.worker) + ',' + std::to_string(span.begin_ns) + ',' +
            std::to_string(span.end_ns) + ',' + std::to_string(span.end_ns - span.begin_ns) + ',' +
            std::to_string(span.bound_ns) + ',' +
            ((span.flags & k_span_overran) != 0 ? "1," : "0,") +
            ((span.flags & k_span_will_miss) != 0 ? "1," : "0,") +
            ((span.flags & k_span_injected) != 0 ? "1\n" : "0\n");
  }
  return text;
}

std::string btf_trace(const TraceFile& trace) {
  std::vector<BtfLine> lines;
  const auto add = [&](std::int64_t time, int order, const std::string& rest) {
    lines.push_back({time, order, std::to_string(time) + ',' + rest});
  };
  const auto task_of = [&](const TraceSpan& span) {
    return btf_name(trace.group_name(span)) + "_" + std::to_string(span.worker);
  };
  std::map<std::pair<std::string, std::uint64_t>, TaskInstance> tasks;
  for (const TraceSpan& span : trace.spans) {
    if ((span.flags & k_span_release) != 0) continue;
    const std::string instance = std::to_string(span.activation);
    const std::string runnable = task_of(span) + ',' + instance + ",R," +
                                 btf_name(trace.node_name(span)) + ',' + instance + ',';
    add(span.begin_ns, 4, runnable + "start,");
    add(span.end_ns, span.begin_ns == span.end_ns ? 5 : 0, runnable + "terminate,");
    const bool first = tasks.count({task_of(span), span.activation}) == 0;
    TaskInstance& task = tasks[{task_of(span), span.activation}];
    task.begin_ns = first ? span.begin_ns : std::min(task.begin_ns, span.begin_ns);
    task.end_ns = first ? span.end_ns : std::max(task.end_ns, span.end_ns);
    if (is_node(span)) task.core = trace.groups[span.group].cores[span.node];
  }
  for (const auto& [key, task] : tasks) {
    const std::string instance = std::to_string(key.second);
    const std::string target = ",T," + key.first + ',' + instance + ',';
    const std::string core = "Core_" + std::to_string(task.core) + ",0" + target;
    add(task.begin_ns, 2, "STI_" + key.first + ',' + instance + target + "activate,");
    add(task.begin_ns, 3, core + "start,");
    // After the end of its last runnable, also if that one took no time.
    add(task.end_ns, task.begin_ns == task.end_ns ? 6 : 1, core + "terminate,");
  }
  std::stable_sort(lines.begin(), lines.end(), [](const BtfLine& a, const BtfLine& b) {
    return a.time_ns != b.time_ns ? a.time_ns < b.time_ns : a.order < b.order;
  });
  std::string text = "#version 2.2.0\n#creator glint\n#creationDate " +
                     date_of(trace.epoch_unix_ns) + "\n#timeScale ns\n";
  for (const BtfLine& line : lines) text += line.text + '\n';
  return text;
}

TraceFormat trace_format_of(std::string_view name) {
  if (name == "perfetto") return TraceFormat::perfetto;
  if (name == "chrome") return TraceFormat::chrome;
  if (name == "btf") return TraceFormat::btf;
  if (name == "csv") return TraceFormat::csv;
  throw InputError("--format " + std::string(name) + "; expected perfetto, chrome, btf or csv");
}

std::string exported(const TraceFile& trace, TraceFormat format) {
  switch (format) {
    case TraceFormat::perfetto:
      return perfetto_trace(trace);
    case TraceFormat::chrome:
      return chrome_trace(trace);
    case TraceFormat::btf:
      return btf_trace(trace);
    case TraceFormat::csv:
      break;
  }
  return csv_trace(trace);
}

}  // namespace glint
