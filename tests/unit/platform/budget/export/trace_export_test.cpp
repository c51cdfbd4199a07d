#include "platform/budget/export/trace_export.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "platform/budget/export/protobuf_writer.hpp"
#include "platform/input_error.hpp"
#include "tests/unit/platform/budget/report/sample_files.hpp"

namespace glint {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> columns_of(const std::string& line) {
  std::vector<std::string> columns;
  std::istringstream in(line + ',');
  for (std::string column; std::getline(in, column, ',');) columns.push_back(column);
  return columns;
}

TEST(TraceFile, ComesBackAsItWasWritten) {
  const std::string path = testing::TempDir() + "/written.spans";
  const TraceFile trace = sample_trace({.frames = 20});
  write_trace(path, trace);
  const TraceFile again = read_trace(path);
  ASSERT_EQ(again.spans.size(), trace.spans.size());
  EXPECT_EQ(0, std::memcmp(again.spans.data(), trace.spans.data(),
                           trace.spans.size() * sizeof(TraceSpan)));
  EXPECT_EQ(again.groups[0].nodes, trace.groups[0].nodes);
  EXPECT_EQ(again.groups[0].cores, trace.groups[0].cores);
  EXPECT_EQ(again.board, "sample-x86-64");
}

TEST(TraceFile, LeavesOutASpanThatWasCutInTwo) {
  const std::string path = testing::TempDir() + "/cut.spans";
  const TraceFile trace = sample_trace({.frames = 20});
  write_trace(path, trace);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 7);
  EXPECT_EQ(read_trace(path).spans.size(), trace.spans.size() - 1);
}

TEST(TraceFile, RefusesASpanOfANodeThatTheHeaderDoesNotName) {
  const std::string path = testing::TempDir() + "/foreign.spans";
  TraceFile trace = sample_trace({.frames = 20});
  trace.spans[3].node = 200;
  trace.spans[3].flags = 0;
  write_trace(path, trace);
  EXPECT_THROW((void)read_trace(path), InputError);
  std::ofstream(path) << "no trace\n";
  EXPECT_THROW((void)read_trace(path), InputError);
}

TEST(TraceFile, KeepsOfOneFrameWhatRanUntilItLeft) {
  const TraceFile trace = sample_trace({.frames = 20});
  const TraceFile part = around_frame(trace, 7);
  std::size_t nodes = 0, sent = 0;
  for (const TraceSpan& span : part.spans) {
    if (span.group == 0 && is_node(span)) {
      EXPECT_EQ(span.frame_sequence, 7U);
      ++nodes;
    }
    sent += (span.flags & k_span_sent) != 0 && span.frame_sequence == 7 ? 1 : 0;
  }
  EXPECT_EQ(nodes, 14U);
  EXPECT_EQ(sent, 1U);
  EXPECT_THROW((void)around_frame(trace, 99), InputError);
}

// Source: Protocol Buffers, Encoding: examples 150 and "testing".
TEST(ProtobufWriter, WritesTheFormatsOwnExamples) {
  ProtobufWriter writer;
  writer.number(1, 150);
  writer.bytes(2, "testing");
  EXPECT_EQ(writer.data(), std::string("\x08\x96\x01\x12\x07testing"));
}

TEST(TraceExport, GivesChromeOneCompleteEventASpan) {
  const TraceFile trace = sample_trace({.frames = 20});
  const auto json = nlohmann::json::parse(chrome_trace(trace));
  std::size_t complete = 0;
  for (const auto& event : json.at("traceEvents")) {
    if (event.at("ph") != "X") continue;
    const TraceSpan& span = trace.spans[complete++];
    EXPECT_EQ(event.at("name"), trace.node_name(span));
    EXPECT_DOUBLE_EQ(event.at("ts").get<double>(), static_cast<double>(span.begin_ns) * 1e-3);
  }
  EXPECT_EQ(complete, trace.spans.size());
}

TEST(TraceExport, GivesCsvARowASpanAndAlwaysTwelveColumns) {
  const TraceFile trace = sample_trace({.frames = 20});
  const auto lines = lines_of(csv_trace(trace));
  ASSERT_EQ(lines.size(), trace.spans.size() + 1);
  for (const std::string& line : lines) EXPECT_EQ(columns_of(line).size(), 12U) << line;
}

// Best Trace Format: eight columns in order of time; each entity follows its state machine.
TEST(TraceExport, GivesBtfEveryTaskAndRunnableInItsOrderOfStates) {
  const auto lines = lines_of(btf_trace(sample_trace({.frames = 20})));
  std::map<std::string, std::string> state;
  std::int64_t last_ns = 0;
  std::size_t events = 0;
  for (const std::string& line : lines) {
    if (line.front() == '#') continue;
    const auto columns = columns_of(line);
    ASSERT_EQ(columns.size(), 8U) << line;
    EXPECT_GE(std::stoll(columns[0]), last_ns) << line;
    last_ns = std::stoll(columns[0]);
    std::string& now = state[columns[3] + columns[4] + '/' + columns[5]];
    const std::string& event = columns[6];
    if (event == "activate") {
      EXPECT_EQ(now, "") << line;
    }
    if (event == "start") {
      EXPECT_EQ(now, columns[3] == "T" ? "activate" : "") << line;
    }
    if (event == "terminate") {
      EXPECT_EQ(now, "start") << line;
    }
    if (columns[3] == "R") {
      EXPECT_EQ(state['T' + columns[1] + '/' + columns[2]], "start") << line;
    }
    now = event;
    ++events;
  }
  EXPECT_GT(events, 20U * 2 * 14);
  for (const auto& [entity, last] : state) EXPECT_EQ(last, "terminate") << entity;
}

TEST(TraceExport, RefusesAFormatItDoesNotWrite) {
  EXPECT_THROW((void)trace_format_of("ctf"), InputError);
}

}  // namespace
}  // namespace glint
