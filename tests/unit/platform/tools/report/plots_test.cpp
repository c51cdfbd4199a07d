#include "platform/tools/report/plots.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "platform/input_error.hpp"

namespace glint {
namespace {

int occurrences(const std::string& text, const std::string& word) {
  int count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    ++count;
  return count;
}

TEST(Plots, WritesNumbersWithoutNeedlessDigits) {
  EXPECT_EQ(number_text(1.5, 3), "1.5");
  EXPECT_EQ(number_text(-0.0001, 2), "0");
  EXPECT_EQ(number_text(100, 2), "100");
  EXPECT_EQ(number_text(std::nan(""), 2), "-");
}

TEST(Plots, PutsTicksAtRoundNumbersInsideTheRange) {
  const Ticks ticks = round_ticks({-0.31, 0.52}, 5);
  ASSERT_EQ(ticks.values.size(), 4u);
  EXPECT_NEAR(ticks.values.front(), -0.2, 1e-12);
  EXPECT_NEAR(ticks.values.back(), 0.4, 1e-12);
  EXPECT_EQ(ticks.decimals, 1);
  EXPECT_EQ(round_ticks({0, 1000}, 4).decimals, 0);
}

TEST(Plots, GivesAnEmptyRangeAWidth) {
  EXPECT_GT(with_margin({3, 3}, 0).span(), 0);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_GT(with_margin({infinity, -infinity}, 0).span(), 0);
}

TEST(Plots, MapsValuesToTheFrameWithYUpwards) {
  SvgCanvas canvas(200, 100);
  const Axes axes(canvas, {10, 20}, {100, 50}, {0, 10}, {-1, 1});
  EXPECT_EQ(axes.to_canvas(0, 1), Vector2(10, 20));
  EXPECT_EQ(axes.to_canvas(10, -1), Vector2(110, 70));
}

TEST(Plots, BreaksALineWhereAPointIsNotFinite) {
  SvgCanvas canvas(10, 10);
  const std::vector<Vector2> points = {{0, 0}, {1, 1}, {std::nan(""), 2}, {3, 3}, {4, 4}};
  canvas.polyline(points, {});
  EXPECT_NE(canvas.finished().find("M0 0L1 1M3 3L4 4"), std::string::npos);
}

TEST(Plots, EscapesWhatXmlWouldMisread) {
  SvgCanvas canvas(10, 10);
  canvas.text({0, 0}, "a < b & \"c\"");
  EXPECT_NE(canvas.finished().find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
}

TEST(Plots, DrawsABarForEachFilledBinAndALineForEachFit) {
  HistogramSeries series;
  series.name = "seed";
  series.histogram.counts = {1, 4, 0, 9, 4, 1};
  series.fit = {true, 3, 1, 9};
  const std::string svg = histogram_plot({"errors", "mm", "density"}, std::vector{series});
  EXPECT_EQ(occurrences(svg, "fill-opacity=\"0.4\""), 5);
  EXPECT_EQ(occurrences(svg, "<path"), 1);
  EXPECT_EQ(occurrences(svg, "Gaussian fit, sd 1<"), 1);
  EXPECT_EQ(occurrences(svg, "</svg>"), 1);
}

TEST(Plots, DrawsATrajectoryFromTwoSidesAtOneScale) {
  const std::vector<TrajectorySeries> series = {{"truth", {{0, 0, 0}, {2, 0, 0.1}}},
                                                {"glint", {{0, 0, 0}, {2, 0.01, 0.1}}}};
  const std::string svg = trajectory_plot("pen", series);
  EXPECT_EQ(occurrences(svg, "<path"), 4);
  EXPECT_EQ(occurrences(svg, "from above"), 1);
  EXPECT_EQ(occurrences(svg, "from the side"), 1);
}

TEST(Plots, MarksTheLatenciesThatMatter) {
  std::vector<double> latencies;
  for (int i = 1; i <= 1000; ++i) latencies.push_back(i);
  const std::string svg = latency_plot("frame to CAN", latencies);
  for (const char* words : {"p50 500 us", "p99 990 us", "p99.9 999 us", "max 1000 us"})
    EXPECT_EQ(occurrences(svg, words), 1) << words;
  EXPECT_EQ(occurrences(latency_plot("nothing", {}), "</svg>"), 1);
}

TEST(Plots, NeverLeavesAHalfWrittenFile) {
  const auto folder = std::filesystem::temp_directory_path() / "glint_plots_test";
  std::filesystem::remove_all(folder);
  EXPECT_THROW(write_text_file((folder / "absent" / "a.svg").string(), "x"), InputError);
  std::filesystem::create_directories(folder / "taken.svg");
  EXPECT_THROW(write_text_file((folder / "taken.svg").string(), "x"), InputError);
  write_text_file((folder / "a.svg").string(), "old");
  write_text_file((folder / "a.svg").string(), "new");
  std::ifstream file(folder / "a.svg");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "new");
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files += entry.exists();
  EXPECT_EQ(files, 2);  // a.svg and the folder taken.svg; no temporary files
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace glint
