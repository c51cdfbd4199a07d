// Undistortion of centroids, as Glint does it, against centroids of the undistorted frame.
#include <gtest/gtest.h>

#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "kernels/image/blobs.hpp"
#include "kernels/image/roi_threshold.hpp"
#include "platform/formats/camera.hpp"

namespace glint {
namespace {

constexpr std::uint16_t k_threshold = 4000;

std::vector<Vector2> centroids_of(const cv::Mat& image) {
  Frame frame;
  frame.reflectivity_16 = {image.ptr<std::uint16_t>(), image.cols, image.rows};
  auto runs = std::make_unique<Runs>();
  auto scratch = std::make_unique<BlobScratch>();
  auto blobs = std::make_unique<Blobs>();
  threshold_runs(frame, whole_frame(frame), k_threshold, {}, *runs);
  const Runs* bands[] = {runs.get()};
  find_blobs(frame, bands, {3, 2000, k_threshold, 0xFFFF}, {}, *scratch, *blobs);
  std::vector<Vector2> out;
  for (int i = 0; i < blobs->count; ++i) {
    out.push_back(blobs->items[static_cast<std::size_t>(i)].centroid_px);
  }
  return out;
}

// Image of discs that face the camera through a lens; each pixel is the mean of 6 x 6 rays.
cv::Mat render(const CameraModel& camera, const std::vector<Vector2>& discs, double radius) {
  cv::Mat image(camera.height, camera.width, CV_16UC1, cv::Scalar(300));
  for (const Vector2& disc : discs) {
    const Vector2 middle = project(camera, {disc.x(), disc.y(), 1}).value;
    for (int y = static_cast<int>(middle.y()) - 10; y < middle.y() + 10; ++y) {
      for (int x = static_cast<int>(middle.x()) - 10; x < middle.x() + 10; ++x) {
        int inside = 0;
        for (int i = 0; i < 36; ++i) {
          const Vector3 ray =
              unproject(camera, {x + (i % 6 + 0.5) / 6, y + (i / 6 + 0.5) / 6}).value;
          inside += (ray.head<2>() / ray.z() - disc).norm() < radius;
        }
        if (inside == 0) continue;
        image.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(300 + 20000 * inside / 36);
      }
    }
  }
  return image;
}

TEST(UndistortBlobs, AgreesWithUndistortingTheFrame) {
  CameraModel camera = hololens1_short_throw().model;
  camera.distortion = {-0.12, 0.03, 0.001, -0.0008, 0, 0, 0, 0};  // stronger than the preset's
  std::vector<Vector2> discs;
  for (int i = 0; i < 25; ++i) {
    discs.emplace_back(-0.55 + 0.27 * (i % 5) + 0.013 * (i / 5), -0.6 + 0.29 * (i / 5) + 0.007 * i);
  }
  const cv::Mat frame = render(camera, discs, 0.014);

  // Undistort the frame, then compute centroids.
  const cv::Matx33d matrix{camera.fx, 0, camera.cx - 0.5, 0, camera.fy, camera.cy - 0.5, 0, 0, 1};
  const auto& k = camera.distortion;
  cv::Mat map_x, map_y, undistorted;
  cv::initUndistortRectifyMap(matrix, std::vector<double>{k[0], k[1], k[2], k[3], k[4]},
                              cv::noArray(), matrix, frame.size(), CV_32FC1, map_x, map_y);
  cv::remap(frame, undistorted, map_x, map_y, cv::INTER_LINEAR);
  const std::vector<Vector2> from_frame = centroids_of(undistorted);

  // Compute centroids, then undistort them.
  std::vector<Vector2> from_blobs;
  double moved = 0;
  for (const Vector2& pixel : centroids_of(frame)) {
    const Vector3 ray = unproject(camera, pixel).value;
    from_blobs.emplace_back(camera.fx * ray.x() / ray.z() + camera.cx,
                            camera.fy * ray.y() / ray.z() + camera.cy);
    moved = std::max(moved, (from_blobs.back() - pixel).norm());
  }
  ASSERT_EQ(from_blobs.size(), discs.size());
  ASSERT_EQ(from_frame.size(), discs.size());
  EXPECT_GT(moved, 5);  // the distortion is significant
  for (const Vector2& a : from_blobs) {
    double nearest = 1e9;
    for (const Vector2& b : from_frame) nearest = std::min(nearest, (a - b).norm());
    EXPECT_LT(nearest, 0.05) << a.transpose();
  }
}

}  // namespace
}  // namespace glint
