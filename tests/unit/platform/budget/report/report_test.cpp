#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "platform/budget/report/budget_report.hpp"
#include "platform/budget/report/drawing.hpp"
#include "platform/budget/report/sections.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "tests/unit/platform/budget/report/sample_files.hpp"

namespace glint {
namespace {

class BudgetReport : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(testing::TempDir()) /
        ("budget_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const char* name) const { return (folder_ / name).string(); }

  Document report(SampleSettings settings) {
    settings.frames = std::min(settings.frames, 1300);
    write_samples(folder_.string(), settings);
    return budget_report(read_sources({{path("measure.json"), path("measure_time.json")},
                                       path("check.json"),
                                       path("run"),
                                       path("footprint.json")}),
                         {});
  }

  std::filesystem::path folder_;
};

const Section& section(const Document& document, const std::string& id) {
  const auto found = std::find_if(document.sections.begin(), document.sections.end(),
                                  [&](const Section& s) { return s.id == id; });
  if (found == document.sections.end()) throw std::runtime_error("no section " + id);
  return *found;
}

const Table& table(const Section& section, std::size_t number = 0) {
  for (const Block& block : section.blocks) {
    if (const Table* found = std::get_if<Table>(&block)) {
      if (number-- == 0) return *found;
    }
  }
  throw std::runtime_error("no table in " + section.id);
}

bool some_reason_has(const Document& document, const std::string& words) {
  return std::any_of(document.reasons.begin(), document.reasons.end(), [&](const Sentence& reason) {
    return reason.text.find(words) != std::string::npos;
  });
}

TEST_F(BudgetReport, HoldsWhereEveryBoundMeetsItsDeadlineAndNothingSeenLiesAboveIt) {
  const Document document = report({});
  EXPECT_EQ(document.verdict, Verdict::holds) << document.reasons.front().text;
  EXPECT_TRUE(some_reason_has(document, "best effort"));
}

TEST_F(BudgetReport, IsVoidWhereOneNodeOnceTookLongerThanItsBound) {
  const Document document = report({.one_frame_above_bound = true});
  EXPECT_EQ(document.verdict, Verdict::invalid_bound);
  EXPECT_TRUE(some_reason_has(document, "FindBlobs: 1 of 1300 calls above their bound of 58"));
}

TEST_F(BudgetReport, CallsNoLatencyObservedThatNoClockSaw) {
  const Document document = report({.real_time = false});
  EXPECT_EQ(document.headlines.back().kind, NumberKind::observed);
  EXPECT_EQ(document.headlines.back().value, "not given");
  EXPECT_EQ(document.headlines.back().provenance, "the run in " + path("run") + " was not live");
  EXPECT_TRUE(some_reason_has(document, "was not live: its latencies are nominal"));
  EXPECT_NE(document.verdict_text.find("was not live"), std::string::npos);
  const Document live = report({});
  EXPECT_NE(live.headlines.back().value, "not given");
  EXPECT_FALSE(some_reason_has(live, "was not live"));
}

TEST_F(BudgetReport, FailsWhereTheCheckFailed) {
  const Document document = report({.check_fails = true});
  EXPECT_EQ(document.verdict, Verdict::fails);
  EXPECT_TRUE(some_reason_has(document, "578 us above its deadline"));
}

TEST_F(BudgetReport, ShowsNothingItWasNotGiven) {
  write_samples(folder_.string(), {.frames = 50});
  const Document document = budget_report(read_sources({{path("measure.json")}, "", "", ""}), {});
  EXPECT_EQ(document.verdict, Verdict::not_shown);
  for (const Headline& headline : document.headlines) EXPECT_EQ(headline.value, "not given");
  EXPECT_NE(markdown_of(document).find("Not given: pass `--check F`"), std::string::npos);
}

TEST_F(BudgetReport, KeepsBoundEstimateAndObservedInColumnsOfTheirOwn) {
  const Document document = report({});
  ASSERT_EQ(document.headlines.size(), 3U);
  EXPECT_EQ(document.headlines[0].kind, NumberKind::bound);
  EXPECT_EQ(document.headlines[0].value, "4\u2009474 \u00b5s");
  EXPECT_NE(
      document.headlines[0].provenance.find("371 computed + 4\u2009000 declared + 103 estimate"),
      std::string::npos);
  EXPECT_EQ(document.headlines[1].kind, NumberKind::estimate);
  EXPECT_EQ(document.headlines[1].value, "103 \u00b5s");
  EXPECT_EQ(document.headlines[2].kind, NumberKind::observed);
  // A chain's computed, declared and measured shares add up to its total.
  const Table& chains = table(section(document, "chains"));
  EXPECT_EQ(chains.columns[1].kind, NumberKind::bound);
  EXPECT_EQ(chains.columns[3].kind, NumberKind::estimate);
  EXPECT_EQ(chains.columns[4].kind, NumberKind::none);
  EXPECT_EQ(chains.rows[0][1].text, "371");
  EXPECT_EQ(chains.rows[0][2].text, "4\u2009000");
  EXPECT_EQ(chains.rows[0][3].text, "103");
  EXPECT_EQ(chains.rows[0][4].text, "4\u2009474");
}

TEST_F(BudgetReport, ListsTheWorstFrameFirstWithTheCommandThatShowsIt) {
  const Document document = report({});
  const Table& worst = table(section(document, "worst-frames"));
  ASSERT_EQ(worst.rows.size(), 10U);
  EXPECT_EQ(worst.rows[0][0].text, "1234");
  EXPECT_EQ(worst.rows[0][4].text, "FindBlobs");
  EXPECT_EQ(worst.rows[0][7].text, "`glint budget export --trace " + path("run") +
                                       "/trace.spans --frame 1234 --out frame-1234.pftrace`");
}

TEST_F(BudgetReport, CountsEveryCallOnceInANodesTimes) {
  const Document document = report({});
  const Table& nodes = table(section(document, "nodes"));
  ASSERT_EQ(nodes.rows.size(), 16U);
  EXPECT_EQ(nodes.rows[6][1].text, "FindBlobs");
  EXPECT_EQ(nodes.rows[6][3].text, "1\u2009300");
  EXPECT_EQ(nodes.rows[6][7].text, us_text(0.8 * 58));
  EXPECT_EQ(nodes.rows[6][8].text, "0");
}

// Older measurements name the load "enemy".
TEST_F(BudgetReport, NamesTheLoadOfEachInterference) {
  const Document document = report({});
  std::vector<std::string> loads;
  for (const auto& row : table(section(document, "interference")).rows)
    loads.push_back(row[1].text);
  EXPECT_EQ(loads, (std::vector<std::string>{"cache", "bandwidth", "other_core"}));
}

TEST_F(BudgetReport, SaysNoneWhereTheAnalysisFoundNoBound) {
  write_samples(folder_.string(), {.frames = 50});
  std::ifstream in(path("check.json"));
  auto json = nlohmann::ordered_json::parse(in);
  json["groups"][0]["response_us"] = nullptr;
  json["system_slack_percent"] = nullptr;
  json["can"][0]["response_us"] = nullptr;
  std::ofstream(path("check.json")) << json.dump();
  const Document document = budget_report(read_sources({{}, path("check.json"), "", ""}), {});
  const Table& groups = table(section(document, "groups"));
  EXPECT_EQ(groups.rows[0][4].text, "none");
  EXPECT_EQ(groups.rows[0][6].tone, Tone::bad);
  EXPECT_EQ(table(section(document, "can")).rows[0][2].text, "none");
}

TEST_F(BudgetReport, MarksALoopThatRanMoreOftenThanItMay) {
  write_samples(folder_.string(), {.frames = 50});
  std::ifstream in(path("measure.json"));
  auto json = nlohmann::ordered_json::parse(in);
  json["kernels"][1]["loops"][2]["observed"] = 262145;
  std::ofstream(path("measure.json")) << json.dump();
  const Document document = budget_report(read_sources({{path("measure.json")}, "", "", ""}), {});
  const Table& loops = table(section(document, "loops"));
  EXPECT_EQ(loops.rows[4][3].tone, Tone::bad);
  EXPECT_EQ(loops.rows[3][3].tone, Tone::plain);
}

TEST_F(BudgetReport, SaysTheSameInMarkdownAsOnThePage) {
  const Document document = report({});
  const std::string html = html_of(document), markdown = markdown_of(document);
  for (const Section& part : document.sections) {
    EXPECT_NE(html.find(printable_markup(part.title)), std::string::npos) << part.title;
    EXPECT_NE(markdown.find(part.title), std::string::npos) << part.title;
  }
  for (const Illustration& figure : figures_of(document)) {
    EXPECT_NE(html.find("figure-" + figure.name), std::string::npos) << figure.name;
    EXPECT_NE(markdown.find("figures/" + figure.name + ".svg"), std::string::npos) << figure.name;
  }
}

TEST_F(BudgetReport, NeedsNothingFromOutsideThePage) {
  const std::string html = html_of(report({}));
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  for (const char* outside : {"<script", "src=", "url(", "@import", "<link"}) {
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  }
}

TEST_F(BudgetReport, ShowsNamesFromFilesAsTextAndNeverAsMarkup) {
  write_samples(folder_.string(), {.frames = 50});
  std::ifstream in(path("measure.json"));
  auto json = nlohmann::ordered_json::parse(in);
  json["board"] = "<img src=x onerror=alert(1)>";
  std::ofstream(path("measure.json")) << json.dump();
  const std::string html =
      html_of(budget_report(read_sources({{path("measure.json")}, "", "", ""}), {}));
  EXPECT_EQ(html.find("<img"), std::string::npos);
  EXPECT_NE(html.find("&lt;img"), std::string::npos);
}

TEST_F(BudgetReport, RefusesABrokenFileByItsPlaceInIt) {
  write_samples(folder_.string(), {.frames = 50});
  const auto message_of = [&](const ReportPaths& paths) -> std::string {
    try {
      (void)budget_report(read_sources(paths), {});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  std::ofstream(path("broken.json")) << "{\n \"kernels\": [\n  {,}\n ]}";
  EXPECT_NE(message_of({{path("broken.json")}, "", "", ""}).find("broken.json:3: "),
            std::string::npos);
  std::ofstream(path("short.json")) << R"({"kernels":[{"name":"FindBlobs","loops":[]}]})";
  EXPECT_NE(message_of({{path("short.json")}, "", "", ""})
                .find("short.json: /kernels/0/bound: found nothing; expected a value"),
            std::string::npos);
  const std::string deep = std::string(300'000, '[') + std::string(300'000, ']');
  std::ofstream(path("deep.json")) << R"({"kernels":[{"loops":[],"bound":)" << deep << "}]}";
  EXPECT_NE(message_of({{path("deep.json")}, "", "", ""}).find("deep.json: nested deeper than 32"),
            std::string::npos);
  std::ofstream(path("large.json")) << R"({"kernels":[{"name":"FindBlobs","loops":[1e999]}]})";
  EXPECT_NE(
      message_of({{path("large.json")}, "", "", ""}).find("large.json: a number out of range"),
      std::string::npos);
  EXPECT_NE(message_of({{}, path("measure.json"), "", ""}).find("no \"chains\""),
            std::string::npos);
  EXPECT_NE(message_of({}).find("no input"), std::string::npos);
}

}  // namespace
}  // namespace glint
