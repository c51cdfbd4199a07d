#include "platform/calibrate/board.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "platform/calibrate/say.hpp"
#include "platform/input_error.hpp"
#include "platform/sensors/picture_file.hpp"

namespace glint {
namespace {

const cv::Size k_corner_window(4, 4);  // half of it: no neighbour is so near
constexpr int k_board_parts = 9;
constexpr std::size_t k_corners_min = 6;      // of a picture, without a part
constexpr double k_white_percentile = 0.999;  // a lamp does not make the board dark

// Eight bits, the brightest thousandth white.
cv::Mat eight_bits(const cv::Mat& picture) {
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
  Picture read = read_picture(path);
  cv::Mat picture(read.height, read.width, CV_16UC(read.channels), read.values.data());
  if (read.channels == 3) cv::cvtColor(picture, picture, cv::COLOR_RGB2GRAY);
  if (size.area() > 0 && picture.size() != size) {
    throw InputError(path + ": " + std::to_string(picture.cols) + " x " +
                     std::to_string(picture.rows) + " pixels; expected " +
                     std::to_string(size.width) + " x " + std::to_string(size.height) +
                     " like the first picture");
  }
  return eight_bits(picture);
}

bool find(const cv::Mat& picture, const BoardSettings& settings, std::vector<cv::Point2f>& found) {
  const cv::Size size(settings.columns, settings.rows);
  if (settings.pattern == BoardPattern::circles) return cv::findCirclesGrid(picture, size, found);
  // Brightness made equal finds a board in a bright room, and loses one before a dark background.
  if (!cv::findChessboardCornersSB(picture, size, found, 0) &&
      !cv::findChessboardCornersSB(picture, size, found, cv::CALIB_CB_NORMALIZE_IMAGE))
    return false;
  cv::cornerSubPix(picture, found, k_corner_window, {-1, -1},
                   {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 50, 1e-3});
  return true;
}

// How far the boards' normals spread: the root mean square of their angle to the mean one.
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

CameraModel model_of(const cv::Mat& matrix, const cv::Mat& distortion, const cv::Size& size,
                     Lens lens) {
  CameraModel model;
  model.lens = lens;
  model.width = size.width;
  model.height = size.height;
  model.fx = matrix.at<double>(0, 0);
  model.fy = matrix.at<double>(1, 1);
  model.cx = matrix.at<double>(0, 2) + 0.5;  // OpenCV's pixel centres are at integers
  model.cy = matrix.at<double>(1, 2) + 0.5;
  const int count = lens == Lens::rational ? 8 : 5;
  for (int i = 0; i < count; ++i) {
    model.distortion[static_cast<std::size_t>(i)] = distortion.at<double>(i);
  }
  return model;
}

// A board that was found.
struct View {
  std::vector<cv::Point2f> seen;
  std::size_t frame = 0;
};

struct Views {
  std::string what;
  cv::Size size;
  std::size_t searched = 0;
  std::vector<View> found;
};

Views views_of(const std::vector<std::string>& images, const BoardSettings& settings) {
  Views views{"--images", {}, images.size(), {}};
  for (const std::string& path : images) {
    const cv::Mat picture = load(path, views.size);
    views.size = picture.size();
    View view;
    if (find(picture, settings, view.seen)) views.found.push_back(std::move(view));
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
  return eight_bits(picture);
}

Views views_of(FrameSource& source, const std::string& what, const BoardSettings& settings) {
  Views views{what, {}, 0, {}};
  std::size_t step = k_board_frame_step;
  source.start({});
  ArrivedFrame arrived;
  for (std::size_t number = 0; source.wait(arrived); ++number) {
    if (number % step == 0) {
      ++views.searched;
      const cv::Mat picture = reflectivity_of(arrived.frame);
      views.size = picture.size();
      View view{{}, number};
      if (find(picture, settings, view.seen)) views.found.push_back(std::move(view));
    }
    source.give_back(arrived);
    if (views.found.size() <= k_board_views_max) continue;
    step *= 2;
    std::erase_if(views.found, [&](const View& view) { return view.frame % step != 0; });
  }
  return views;
}

void require_boards(const Views& views, const BoardSettings& settings) {
  if (views.found.size() >= k_board_images_min) return;
  throw InputError(views.what + ": a board of " + std::to_string(settings.columns) + " x " +
                   std::to_string(settings.rows) + " was found in " +
                   std::to_string(views.found.size()) + " of " + std::to_string(views.searched) +
                   " pictures; expected at least " + std::to_string(k_board_images_min) +
                   ": count the inner corners (or circles) of a row and of a column, and show " +
                   "the whole board");
}

std::vector<cv::Point3f> board_points(const BoardSettings& settings) {
  std::vector<cv::Point3f> board;
  const auto spacing = static_cast<float>(settings.spacing_m);
  for (int row = 0; row < settings.rows; ++row)
    for (int column = 0; column < settings.columns; ++column)
      board.emplace_back(spacing * static_cast<float>(column), spacing * static_cast<float>(row),
                         0);
  return board;
}

// Of each picture: corners, and where they are on the board.
struct Seen {
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<std::vector<cv::Point3f>> boards;
};

struct Solved {
  cv::Mat matrix, distortion;
  std::vector<cv::Mat> rotations, translations;
};

// From a start: a rational lens has other minima far away.
Solved solve(const Seen& seen, const cv::Size& size, const BoardSettings& settings,
             const Solved* start) {
  Solved solved;
  int flags = cv::CALIB_USE_QR;
  if (start != nullptr) {
    flags |= cv::CALIB_USE_INTRINSIC_GUESS;
    solved.matrix = start->matrix.clone();
    solved.distortion = cv::Mat::zeros(1, 8, CV_64F);
    for (int i = 0; i < static_cast<int>(start->distortion.total()) && i < 8; ++i)
      solved.distortion.at<double>(i) = start->distortion.at<double>(i);
    if (settings.lens == Lens::rational) flags |= cv::CALIB_RATIONAL_MODEL;
    if (settings.lens == Lens::brown) solved.distortion = start->distortion.clone();
  }
  cv::calibrateCamera(seen.boards, seen.corners, size, solved.matrix, solved.distortion,
                      solved.rotations, solved.translations, flags);
  return solved;
}

// How another lens's pixels lie beside this one's, at corners that were seen: shifted, and wider.
Vector3 difference(const CameraModel& lens, const CameraModel& other,
                   const std::vector<std::vector<cv::Point2f>>& seen) {
  Matrix3 normal = Matrix3::Zero();
  Vector3 sums = Vector3::Zero();
  for (const std::vector<cv::Point2f>& corners : seen) {
    for (const cv::Point2f& corner : corners) {
      const Vector2 pixel(corner.x + 0.5, corner.y + 0.5);
      const Result<Vector3> ray = unproject(lens, pixel);
      const Result<Vector2> moved = ray ? project(other, ray.value) : Result<Vector2>{};
      if (!ray || !moved) continue;
      for (int axis = 0; axis < 2; ++axis) {
        Vector3 row = Vector3::Zero();
        row[axis] = 1;
        row[2] = pixel[axis] - (axis == 0 ? lens.cx : lens.cy);
        normal += row * row.transpose();
        sums += row * (moved.value[axis] - pixel[axis]);
      }
    }
  }
  return normal.ldlt().solve(sums);
}

// Where a part of what was seen ends: a third and two thirds of all.
std::array<float, 2> thirds_of(const std::vector<std::vector<cv::Point2f>>& seen,
                               float cv::Point2f::*axis) {
  std::vector<float> values;
  for (const std::vector<cv::Point2f>& corners : seen)
    for (const cv::Point2f& corner : corners) values.push_back(corner.*axis);
  std::sort(values.begin(), values.end());
  return {values[values.size() / 3], values[2 * values.size() / 3]};
}

// Each time one of 3 x 3 parts of the picture is left out: what the lens has and its model has not
// is alike nearby, not from picture to picture.
void find_sigmas(const Seen& seen, const cv::Size& size, const BoardSettings& settings,
                 const Solved& all, BoardFit& fit) {
  const std::array<float, 2> right = thirds_of(seen.corners, &cv::Point2f::x),
                             down = thirds_of(seen.corners, &cv::Point2f::y);
  const auto third = [](float value, const std::array<float, 2>& ends) {
    return (value > ends[0] ? 1 : 0) + (value > ends[1] ? 1 : 0);
  };
  std::vector<Vector3> found;
  Vector3 mean = Vector3::Zero();
  CameraModel whole = fit.model;
  whole.field_tangent_max = 0;
  for (int part = 0; part < k_board_parts; ++part) {
    Seen rest;
    for (std::size_t i = 0; i < seen.corners.size(); ++i) {
      std::vector<cv::Point2f> corners;
      std::vector<cv::Point3f> board;
      for (std::size_t k = 0; k < seen.corners[i].size(); ++k) {
        const cv::Point2f& corner = seen.corners[i][k];
        if (3 * third(corner.y, down) + third(corner.x, right) == part) continue;
        corners.push_back(corner);
        board.push_back(seen.boards[i][k]);
      }
      if (corners.size() < k_corners_min) continue;
      rest.corners.push_back(std::move(corners));
      rest.boards.push_back(std::move(board));
    }
    const Solved solved = solve(rest, size, settings, &all);
    const CameraModel other = model_of(solved.matrix, solved.distortion, size, settings.lens);
    found.push_back(difference(whole, other, seen.corners));
    mean += found.back() / double{k_board_parts};
  }
  Vector3 squares = Vector3::Zero();
  for (const Vector3& one : found) squares += (one - mean).cwiseAbs2();
  squares *= double{k_board_parts - 1} / double{k_board_parts};
  fit.principal_point_sigma_px = std::sqrt(0.5 * (squares[0] + squares[1]));
  fit.focal_sigma = std::sqrt(squares[2]);
}

BoardFit fit_lens(const Views& views, const BoardSettings& settings) {
  require_boards(views, settings);
  Seen all;
  const std::vector<cv::Point3f> board = board_points(settings);
  for (const View& view : views.found) all.corners.push_back(view.seen);
  all.boards.assign(all.corners.size(), board);
  Solved solved = solve(all, views.size, settings, nullptr);
  if (settings.lens == Lens::rational) solved = solve(all, views.size, settings, &solved);
  const auto& [matrix, distortion, rotations, translations] = solved;
  const std::vector<std::vector<cv::Point2f>>& seen = all.corners;
  BoardFit fit;
  fit.tilt_rad = tilt_of(rotations);
  if (fit.tilt_rad < settings.tilt_min_rad) {
    throw InputError(views.what + ": the board's normal moved by only " +
                     say_degrees(fit.tilt_rad) +
                     " rms, so the focal length stays open; expected at least " +
                     say_degrees(settings.tilt_min_rad) + ": tilt the board to all sides");
  }
  fit.model = model_of(matrix, distortion, views.size, settings.lens);
  fit.images = static_cast<int>(views.searched);
  fit.images_used = static_cast<int>(seen.size());
  double sum = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    std::vector<cv::Point2f> projected;
    cv::projectPoints(board, rotations[i], translations[i], matrix, distortion, projected);
    double squares = 0;
    for (std::size_t k = 0; k < projected.size(); ++k) {
      const cv::Point2f miss = projected[k] - seen[i][k];
      const double length = std::hypot(miss.x, miss.y);
      squares += length * length;
      fit.most_px = std::max(fit.most_px, length);
      const double x = (seen[i][k].x + 0.5 - fit.model.cx) / fit.model.fx;
      const double y = (seen[i][k].y + 0.5 - fit.model.cy) / fit.model.fy;
      fit.model.field_tangent_max = std::max(fit.model.field_tangent_max, std::hypot(x, y));
    }
    fit.corners += static_cast<int>(projected.size());
    fit.image_rms_px.push_back(std::sqrt(squares / static_cast<double>(projected.size())));
    sum += squares;
  }
  fit.rms_px = std::sqrt(sum / (2.0 * fit.corners));
  find_sigmas(all, views.size, settings, solved, fit);
  return fit;
}

}  // namespace

BoardFit calibrate_board(const std::vector<std::string>& images, const BoardSettings& settings) {
  return fit_lens(views_of(images, settings), settings);
}

BoardFit calibrate_board(FrameSource& source, const std::string& what,
                         const BoardSettings& settings) {
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
