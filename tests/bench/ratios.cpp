#include "ratios.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "bench_frames.hpp"
#include "platform/lab/baseline/baseline_tracker.hpp"
#include "platform/lab/experiments/glint_chain.hpp"

namespace glint::bench {
namespace {

constexpr int k_rounds = 15;
constexpr int k_frames_a_round = 64;
constexpr double k_front_end_ratio_max = 110;  // multiples of a plain threshold pass, 448x450 8 bit
constexpr double k_roi_speedup_min = 20;
constexpr double k_full_frame_speedup_min = 8;

// CPU time of this thread: other load on the machine hardly changes it.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds_of(const std::function<void()>& run, int frames) {
  const double begin = thread_seconds();
  for (int i = 0; i < frames; ++i) run();
  return thread_seconds() - begin;
}

// A row with its own method and its own player of the frames.
template <class Method, class Process>
Row make_row(std::string name, const Sensor& sensor, std::shared_ptr<Method> method,
             Process process) {
  auto player = std::make_shared<Player>(sensor);
  return {std::move(name), [method, player, process] {
            player->next();
            process(*method, *player);
          }};
}

cv::Mat plane_of(const Frame& frame) {
  const cv::Size size(frame.width(), frame.height());
  return frame.reflectivity_8.empty()
             ? cv::Mat(size, CV_16U, const_cast<std::uint16_t*>(frame.reflectivity_16.pixels))
             : cv::Mat(size, CV_8U, const_cast<std::uint8_t*>(frame.reflectivity_8.pixels));
}

std::vector<Row> rows_of(const Sensor& sensor) {
  BaselineSettings everywhere;
  everywhere.use_roi = false;
  BaselineSettings roi_alone, points_alone;
  roi_alone.undistortion = BaselineUndistortion::roi;
  points_alone.undistortion = BaselineUndistortion::points;
  const auto baseline = [&](const BaselineSettings& settings) {
    return std::make_shared<BaselineTracker>(sensor.camera, sensor.tool, settings);
  };
  const auto glint = [&](SearchArea area) {
    return std::make_shared<GlintChain>(sensor.camera, sensor.tool, area);
  };
  const auto track = [](auto& tracker, const Player& player) {
    (void)tracker.process(player.frame(), player.head());
  };
  const double threshold = sensor.camera.threshold;
  std::vector<Row> rows;
  // Always the same frame: the strictest reference for the baseline's front end.
  const cv::Mat plane = plane_of(sensor.frames.front().view());
  rows.push_back({"plain cv::threshold, one frame again and again",
                  [plane, threshold, out = cv::Mat()]() mutable {
                    cv::threshold(plane, out, threshold, 255, cv::THRESH_BINARY);
                  }});
  rows.push_back(make_row("baseline front end", sensor, baseline({}),
                          [](BaselineTracker& tracker, const Player& player) {
                            (void)tracker.front_end(player.frame());
                          }));
  rows.push_back(make_row("baseline, whole frame", sensor, baseline(everywhere), track));
  rows.push_back(make_row("baseline, ROI", sensor, baseline({}), track));
  rows.push_back(make_row("Glint, whole frame", sensor, glint(SearchArea::whole_frame), track));
  rows.push_back(make_row("Glint, ROI", sensor, glint(SearchArea::predicted), track));
  rows.push_back(
      make_row("baseline, ROI, which alone is remapped", sensor, baseline(roi_alone), track));
  rows.push_back(
      make_row("baseline, raw ROI, points undistorted", sensor, baseline(points_alone), track));
  return rows;
}

bool print_bar(const char* what, double ratio, double bar, bool at_most) {
  const bool met = at_most ? ratio <= bar : ratio >= bar;
  std::printf("  %-52s %8.1f x   bar: at %s %.0f x   %s\n", what, ratio, at_most ? "most" : "least",
              bar, met ? "met" : "MISSED");
  return met;
}

void print_ratio(const char* what, double ratio) {
  std::printf("  %-52s %8.1f x   no bar\n", what, ratio);
}

}  // namespace

void measure_in_turn(std::vector<Row>& rows, int rounds, int frames) {
  std::vector<std::vector<double>> times(rows.size());
  for (int round = 0; round <= rounds; ++round) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double us = seconds_of(rows[i].run, frames) * 1e6 / frames;
      if (round > 0) times[i].push_back(us);  // round 0 is the warm-up
    }
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::sort(times[i].begin(), times[i].end());
    rows[i].median_us = times[i][times[i].size() / 2];
  }
}

bool print_ratios() {
  bool met = true;
  for (const Sensor* sensor : {&short_throw(), &ahat()}) {
    std::vector<Row> rows = rows_of(*sensor);
    measure_in_turn(rows, k_rounds, k_frames_a_round);
    std::printf("\n%s, one thread, processor time, median of %d rounds of %d frames in turn\n",
                sensor->name.c_str(), k_rounds, k_frames_a_round);
    for (const Row& row : rows)
      std::printf("  %-52s %9.2f us a frame\n", row.name.c_str(), row.median_us);
    const auto us = [&](int row) { return rows[static_cast<std::size_t>(row)].median_us; };
    if (sensor->camera.reflectivity_bits == 8)
      met &= print_bar("baseline front end / plain cv::threshold", us(1) / us(0),
                       k_front_end_ratio_max, true);
    met &= print_bar("baseline / Glint, both with ROI", us(3) / us(5), k_roi_speedup_min, false);
    met &= print_bar("baseline / Glint, both on the whole frame", us(2) / us(4),
                     k_full_frame_speedup_min, false);
    print_ratio("baseline that remaps the ROI alone / Glint with ROI", us(6) / us(5));
    print_ratio("baseline on the raw ROI, less work / Glint with ROI", us(7) / us(5));
  }
  return met;
}

}  // namespace glint::bench
