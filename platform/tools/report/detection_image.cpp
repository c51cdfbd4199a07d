#include "platform/tools/report/detection_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "platform/formats/image_file.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr int k_enlarge = 2;  // for markers of about 6 px
constexpr int k_line_height = 20;
constexpr double k_white_part = 0.999;
const cv::Scalar k_roi_colour{80, 200, 80}, k_blob_colour{60, 160, 255},
    k_marker_colour{255, 220, 60}, k_tool_colour{255, 90, 255}, k_text_colour{230, 230, 230};

std::uint16_t reflectivity_at(const Frame& frame, int x, int y) {
  return frame.reflectivity_8.empty() ? frame.reflectivity_16.row(y)[x]
                                      : std::uint16_t{frame.reflectivity_8.row(y)[x]};
}

cv::Mat tone_mapped(const Frame& frame) {
  std::vector<std::uint16_t> values;
  values.reserve(static_cast<std::size_t>(frame.width()) *
                 static_cast<std::size_t>(frame.height()));
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) values.push_back(reflectivity_at(frame, x, y));
  }
  const auto at = static_cast<std::size_t>(k_white_part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  const double white = std::max<double>(values[at], 1);
  cv::Mat grey(frame.height(), frame.width(), CV_8UC1);
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) {
      const double part = std::min(reflectivity_at(frame, x, y) / white, 1.0);
      grey.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(255 * std::sqrt(part));
    }
  }
  cv::Mat large, colour;
  cv::resize(grey, large, {}, k_enlarge, k_enlarge, cv::INTER_NEAREST);
  cv::cvtColor(large, colour, cv::COLOR_GRAY2BGR);
  return colour;
}

// Converts pixel centres at integer + 0.5 to OpenCV's, which are at integers.
cv::Point to_image_pixel(const Vector2& pixel) {
  const auto to_int = [](double v) {
    return static_cast<int>(std::lround(std::clamp(v * k_enlarge - 0.5, -1e6, 1e6)));
  };
  return {to_int(pixel.x()), to_int(pixel.y())};
}

void write_text(cv::Mat& picture, const std::string& text, cv::Point at, const cv::Scalar& colour) {
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.42, colour, 1, cv::LINE_AA);
}

void draw_blobs(cv::Mat& picture, const Blobs& blobs, const Markers& markers,
                std::span<const std::string> names) {
  std::vector<const Marker*> marker_of(static_cast<std::size_t>(std::max(blobs.count, 0)), nullptr);
  for (int i = 0; i < markers.count; ++i) {
    const Marker& marker = markers.items[static_cast<std::size_t>(i)];
    if (marker.blob < marker_of.size()) marker_of[marker.blob] = &marker;
  }
  for (std::size_t i = 0; i < marker_of.size(); ++i) {
    const Blob& blob = blobs.items[i];
    const Marker* marker = marker_of[i];
    const bool ranged = marker != nullptr && !(marker->flags & k_marker_no_depth);
    const std::string name = i < names.size() ? names[i] : "";
    const cv::Scalar& colour = !name.empty() ? k_tool_colour
                               : ranged      ? k_marker_colour
                                             : k_blob_colour;
    const cv::Point middle = to_image_pixel(blob.centroid_px);
    const int side = std::max(blob.x1 - blob.x0, blob.y1 - blob.y0);
    const int radius = k_enlarge * (side / 2 + 3);
    cv::circle(picture, middle, radius, colour, 1, cv::LINE_AA);
    std::array<char, 48> label{};
    if (ranged) {
      std::snprintf(label.data(), label.size(), "%zu: %.3f m", i, marker->surface_range_m);
    } else {
      std::snprintf(label.data(), label.size(), "%zu", i);
    }
    write_text(picture, label.data() + (name.empty() ? "" : "  " + name),
               middle + cv::Point(radius + 2, 4), colour);
  }
}

}  // namespace

void write_detection_image(const std::string& path, const Frame& frame, const Rois& rois,
                           const Blobs& blobs, const Markers& markers,
                           std::span<const std::string> lines, std::span<const std::string> names) {
  if (frame.width() <= 0 || frame.height() <= 0) {
    throw InputError(path + ": the frame has no reflectivity; expected at least one pixel");
  }
  const cv::Mat image = tone_mapped(frame);
  const int text_height = lines.empty() ? 0 : static_cast<int>(lines.size()) * k_line_height + 8;
  cv::Mat picture(image.rows + text_height, image.cols, CV_8UC3, cv::Scalar::all(24));
  image.copyTo(picture(cv::Rect(0, 0, image.cols, image.rows)));
  for (int i = 0; i < rois.count; ++i) {
    const Roi& roi = rois.items[static_cast<std::size_t>(i)];
    cv::rectangle(picture, cv::Point(roi.x0, roi.y0) * k_enlarge,
                  cv::Point(roi.x1, roi.y1) * k_enlarge - cv::Point(1, 1), k_roi_colour);
  }
  draw_blobs(picture, blobs, markers, names);
  int baseline = image.rows + k_line_height - 4;
  for (const std::string& line : lines) {
    write_text(picture, line, {6, baseline}, k_text_colour);
    baseline += k_line_height;
  }
  cv::cvtColor(picture, picture, cv::COLOR_BGR2RGB);
  write_png(path, picture.cols, picture.rows, 3, picture.data, "a path in a writable folder");
}

}  // namespace glint
