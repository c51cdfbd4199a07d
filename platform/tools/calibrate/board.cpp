#include "platform/tools/calibrate/board.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "platform/formats/image_file.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/calibrate/board_lens.hpp"
#include "platform/tools/calibrate/figure_text.hpp"

namespace glint {
namespace {

const cv::Size k_corner_window(4, 4);         // half size; smaller than the corners' spacing
constexpr double k_white_percentile = 0.999;  // a lamp in the image does not darken the target

// Returns an 8-bit image, scaled so that the brightest thousandth saturates.
cv::Mat to_8_bit(const cv::Mat& picture) {
  cv::Mat values;
  picture.reshape(1, 1).convertTo(values, CV_32F);
  std::vector<float> sorted(values.begin<float>(), values.end<float>());
  const auto at =
      static_cast<std::ptrdiff_t>(k_white_percentile * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
  const double white = std::max(1.0f, sorted[static_cast<std::size_t>(at)]);
  cv::Mat result;
  picture.convertTo(result, CV_8U, 255.0 / white);
  return result;
}

cv::Mat load(const std::string& path, const cv::Size& size) {
  Image read = read_image_file(path);
  cv::Mat picture(read.height, read.width, CV_16UC(read.channels), read.values.data());
  if (read.channels == 3) cv::cvtColor(picture, picture, cv::COLOR_RGB2GRAY);
  if (size.area() > 0 && picture.size() != size) {
    throw InputError(path + ": " + std::to_string(picture.cols) + " x " +
                     std::to_string(picture.rows) + " pixels; expected " +
                     std::to_string(size.width) + " x " + std::to_string(size.height) +
                     ", as in the first image");
  }
  return to_8_bit(picture);
}

bool find_target(const cv::Mat& picture, const CameraCalibrationSettings& settings,
                 std::vector<cv::Point2f>& found) {
  const cv::Size size(settings.columns, settings.rows);
  if (settings.pattern == TargetPattern::circles) return cv::findCirclesGrid(picture, size, found);
  // CALIB_CB_NORMALIZE_IMAGE finds a target in a bright scene but misses one before a dark
  // background: it is the second attempt.
  if (!cv::findChessboardCornersSB(picture, size, found, 0) &&
      !cv::findChessboardCornersSB(picture, size, found, cv::CALIB_CB_NORMALIZE_IMAGE))
    return false;
  cv::cornerSubPix(picture, found, k_corner_window, {-1, -1},
                   {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 50, 1e-3});
  return true;
}

// Spread of the target normals: root mean square of the angle to their mean.
double tilt_of(const std::vector<cv::Mat>& rotations) {
  std::vector<Vector3> normals;
  Vector3 sum = Vector3::Zero();
  for (const cv::Mat& vector : rotations) {
    cv::Mat matrix;
    cv::Rodrigues(vector, matrix);
    normals.emplace_back(matrix.at<double>(0, 2), matrix.at<double>(1, 2), matrix.at<double>(2, 2));
    sum += normals.back();
  }
  double squares = 0;
  for (const Vector3& normal : normals) squares += normal.cross(sum.normalized()).squaredNorm();
  return std::sqrt(squares / static_cast<double>(normals.size()));
}

// One detection of the target.
struct View {
  std::vector<cv::Point2f> corners_px;
  std::size_t frame = 0;
};

struct Views {
  std::string what;
  cv::Size size;
  std::size_t searched = 0;
  std::vector<View> found;
};

Views views_of(const std::vector<std::string>& images, const CameraCalibrationSettings& settings) {
  Views views{"--images", {}, images.size(), {}};
  for (const std::string& path : images) {
    const cv::Mat picture = load(path, views.size);
    views.size = picture.size();
    View view;
    if (find_target(picture, settings, view.corners_px)) views.found.push_back(std::move(view));
  }
  return views;
}

cv::Mat reflectivity_of(const Frame& frame) {
  cv::Mat picture(frame.height(), frame.width(), CV_16U);
  for (int v = 0; v < picture.rows; ++v) {
    auto* const row = picture.ptr<std::uint16_t>(v);
    if (frame.reflectivity_8.empty()) {
      std::copy_n(frame.reflectivity_16.row(v), picture.cols, row);
    } else {
      std::copy_n(frame.reflectivity_8.row(v), picture.cols, row);
    }
  }
  return to_8_bit(picture);
}

Views views_of(FrameSource& source, const std::string& what,
               const CameraCalibrationSettings& settings) {
  Views views{what, {}, 0, {}};
  std::size_t step = k_target_frame_step;
  source.start({});
  ArrivedFrame arrived;
  for (std::size_t number = 0; source.wait(arrived); ++number) {
    if (number % step == 0) {
      ++views.searched;
      const cv::Mat picture = reflectivity_of(arrived.frame);
      views.size = picture.size();
      View view{{}, number};
      if (find_target(picture, settings, view.corners_px)) views.found.push_back(std::move(view));
    }
    source.release_pixels(arrived);
    if (views.found.size() <= k_target_views_max) continue;
    step *= 2;
    std::erase_if(views.found, [&](const View& view) { return view.frame % step != 0; });
  }
  return views;
}

void require_detections(const Views& views, const CameraCalibrationSettings& settings) {
  if (views.found.size() >= k_target_images_min) return;
  throw InputError(views.what + ": a target of " + std::to_string(settings.columns) + " x " +
                   std::to_string(settings.rows) + " was found in " +
                   std::to_string(views.found.size()) + " of " + std::to_string(views.searched) +
                   " images; expected at least " + std::to_string(k_target_images_min) +
                   ": count the inner corners (or circles) of a row and of a column, and show " +
                   "the whole target");
}

std::vector<cv::Point3f> target_points(const CameraCalibrationSettings& settings) {
  std::vector<cv::Point3f> board;
  const auto spacing = static_cast<float>(settings.spacing_m);
  for (int row = 0; row < settings.rows; ++row)
    for (int column = 0; column < settings.columns; ++column)
      board.emplace_back(spacing * static_cast<float>(column), spacing * static_cast<float>(row),
                         0);
  return board;
}

CameraFit fit_lens(const Views& views, const CameraCalibrationSettings& settings) {
  require_detections(views, settings);
  TargetCorners all;
  const std::vector<cv::Point3f> board = target_points(settings);
  for (const View& view : views.found) all.corners.push_back(view.corners_px);
  all.target_points_m.assign(all.corners.size(), board);
  const std::vector<std::vector<cv::Point2f>>& seen = all.corners;
  const TargetLens lens = solve_lens(all, views.size, settings.lens);
  CameraFit fit;
  fit.tilt_rad = tilt_of(lens.rotations);
  if (fit.tilt_rad < settings.tilt_min_rad) {
    throw InputError(views.what + ": the target's normal moved by only " +
                     format_degrees(fit.tilt_rad) +
                     " rms, so the focal length is not observable; expected at least " +
                     format_degrees(settings.tilt_min_rad) + ": tilt the target to all sides");
  }
  fit.model = lens.model;
  fit.images = static_cast<int>(views.searched);
  fit.images_used = static_cast<int>(seen.size());
  double sum = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    std::vector<cv::Point2f> projected;
    cv::projectPoints(board, lens.rotations[i], lens.translations[i], lens.matrix, lens.distortion,
                      projected);
    double squares = 0;
    for (std::size_t k = 0; k < projected.size(); ++k) {
      const cv::Point2f miss = projected[k] - seen[i][k];
      const double length = std::hypot(miss.x, miss.y);
      squares += length * length;
      fit.error_max_px = std::max(fit.error_max_px, length);
      const double x = (seen[i][k].x + 0.5 - fit.model.cx) / fit.model.fx;
      const double y = (seen[i][k].y + 0.5 - fit.model.cy) / fit.model.fy;
      fit.model.field_tangent_max = std::max(fit.model.field_tangent_max, std::hypot(x, y));
    }
    fit.corners += static_cast<int>(projected.size());
    fit.image_rms_px.push_back(std::sqrt(squares / static_cast<double>(projected.size())));
    sum += squares;
  }
  fit.rms_px = std::sqrt(sum / (2.0 * fit.corners));
  const LensSigmas sigmas = lens_sigmas(all, views.size, lens);
  fit.principal_point_sigma_px = sigmas.principal_point_px;
  fit.focal_sigma = sigmas.focal;
  return fit;
}

}  // namespace

CameraFit calibrate_camera(const std::vector<std::string>& images,
                           const CameraCalibrationSettings& settings) {
  return fit_lens(views_of(images, settings), settings);
}

CameraFit calibrate_camera(FrameSource& source, const std::string& what,
                           const CameraCalibrationSettings& settings) {
  return fit_lens(views_of(source, what, settings), settings);
}

std::vector<float> ray_table_of(const CameraModel& model) {
  CameraModel whole = model;
  whole.field_tangent_max = 0;
  std::vector<float> rays;
  for (int v = 0; v < model.height; ++v) {
    for (int u = 0; u < model.width; ++u) {
      const Result<Vector3> ray = unproject(whole, Vector2(u + 0.5, v + 0.5));
      for (int axis = 0; axis < 3; ++axis) {
        rays.push_back(ray ? static_cast<float>(ray.value[axis]) : 0.0f);
      }
    }
  }
  return rays;
}

}  // namespace glint
