// Pictures, cameras and regions of a simulated run, read field by field.
#include <gtest/gtest.h>

#include <set>

#include "kernels/pose/camera_model.hpp"
#include "tests/unit/platform/tools/viewer/collected_messages.hpp"

namespace glint::picture_messages_test {
namespace {

struct ReadRegion {
  float x_px = 0, y_px = 0, distance_m = 0;
  std::uint32_t area_px = 0, peak = 0;
  Roi box;
  std::string reason, marker;
};

Roi box_in(CdrReader& from) {
  Roi box;
  box.x0 = from.get<std::uint16_t>();
  box.y0 = from.get<std::uint16_t>();
  box.x1 = box.x0 + from.get<std::uint16_t>();
  box.y1 = box.y0 + from.get<std::uint16_t>();
  EXPECT_TRUE(from.get_bytes().empty());
  EXPECT_TRUE(from.get_bytes().empty());
  return box;
}

std::vector<ReadRegion> regions_in(const CollectedMessage& message, std::uint32_t threshold) {
  CdrReader from(message.cdr);
  skip_header(from);
  EXPECT_EQ(from.get<std::uint32_t>(), threshold);
  const auto rois = from.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < rois; ++i) (void)box_in(from);
  std::vector<ReadRegion> regions(from.get<std::uint32_t>());
  for (ReadRegion& region : regions) {
    region.x_px = from.get<float>();
    region.y_px = from.get<float>();
    region.area_px = from.get<std::uint32_t>();
    region.peak = from.get<std::uint32_t>();
    region.box = box_in(from);
    region.reason = from.get_text();
    region.marker = from.get_text();
    region.distance_m = from.get<float>();
  }
  EXPECT_FALSE(from.failed());
  EXPECT_TRUE(from.at_end());
  return regions;
}

class ViewedRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    cell_ = new Cell(short_cell(2));
    scenario_ = new sim::Scenario(scenario_of(*cell_));
    run_ = new CollectedMessages(collected_run(*cell_, *scenario_, PicturesTo::observer));
  }
  static void TearDownTestSuite() {
    delete run_;
    delete scenario_;
    delete cell_;
  }
  static const std::vector<CollectedMessage>& on(std::string_view topic) {
    return run_->messages[std::string(topic)];
  }

  static inline Cell* cell_ = nullptr;
  static inline sim::Scenario* scenario_ = nullptr;
  static inline CollectedMessages* run_ = nullptr;
};

TEST_F(ViewedRun, HasAtMostTenPicturesASecond) {
  const auto& pictures = on(k_picture_topic);
  EXPECT_GE(pictures.size(), 15u);
  EXPECT_LE(pictures.size(), 20u);
  EXPECT_EQ(on(k_camera_info_topic).size(), pictures.size());
  EXPECT_EQ(on(k_regions_topic).size(), pictures.size());
  for (std::size_t i = 1; i < pictures.size(); ++i) {
    EXPECT_GE((pictures[i].time - pictures[i - 1].time).seconds(), 0.1);
  }
}

TEST_F(ViewedRun, PicturesShowEveryRegionAtItsPlace) {
  for (std::size_t i = 0; i < on(k_picture_topic).size(); ++i) {
    CdrReader from(on(k_picture_topic)[i].cdr);
    skip_header(from);
    const auto height = from.get<std::uint32_t>(), width = from.get<std::uint32_t>();
    EXPECT_EQ(from.get_text(), "mono16");
    (void)from.get<std::uint8_t>();
    EXPECT_EQ(from.get<std::uint32_t>(), 2 * width);
    const auto bytes = from.get_bytes();
    ASSERT_EQ(bytes.size(), std::size_t{2} * width * height);
    for (const ReadRegion& region : regions_in(on(k_regions_topic)[i], cell_->camera.threshold)) {
      std::uint32_t peak = 0, bright = 0;
      for (int y = region.box.y0; y < region.box.y1; ++y) {
        for (int x = region.box.x0; x < region.box.x1; ++x) {
          const std::size_t at =
              2 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x));
          const std::uint32_t pixel = bytes[at] + 256u * bytes[at + 1];
          peak = std::max(peak, pixel);
          bright += pixel > cell_->camera.threshold ? 1 : 0;
        }
      }
      EXPECT_LE(region.area_px, bright);
      // A candidate's peak is that of its box and the rim around it.
      EXPECT_GE(region.reason.empty() ? region.peak + 1 : peak + 1, region.peak);
      EXPECT_GT(region.peak, cell_->camera.threshold);
    }
  }
}

TEST_F(ViewedRun, RegionsNameThePensMarkersAndWhyOthersAreRefused) {
  std::set<std::string> markers, reasons;
  for (const CollectedMessage& message : on(k_regions_topic)) {
    for (const ReadRegion& region : regions_in(message, cell_->camera.threshold)) {
      if (!region.marker.empty()) {
        markers.insert(region.marker);
        EXPECT_EQ(region.reason, "");
        EXPECT_GT(region.distance_m, 0.1);
        EXPECT_LT(region.distance_m, 1.2);
      }
      reasons.insert(region.reason);
    }
  }
  EXPECT_EQ(markers, (std::set<std::string>{"pen/1", "pen/2", "pen/3", "pen/4", "pen/5"}));
  EXPECT_TRUE(reasons.contains("")) << "candidates";
  EXPECT_GT(reasons.size(), 1u) << "refused ones as well";
}

TEST_F(ViewedRun, CameraInfoIsTheCellsLens) {
  const CameraModel& model = cell_->camera.model;
  CdrReader from(on(k_camera_info_topic).front().cdr);
  skip_header(from);
  EXPECT_EQ(from.get<std::uint32_t>(), static_cast<std::uint32_t>(model.height));
  EXPECT_EQ(from.get<std::uint32_t>(), static_cast<std::uint32_t>(model.width));
  EXPECT_EQ(from.get_text(), "rational_polynomial");
  const auto count = from.get<std::uint32_t>();
  ASSERT_EQ(count, 8u);
  for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(from.get<double>(), model.distortion[i]);
  EXPECT_EQ(from.get<double>(), model.fx);
}

TEST_F(ViewedRun, ByDefaultTheFileHasNoPictures) {
  const CollectedMessages bare = collected_run(*cell_, *scenario_);
  EXPECT_FALSE(bare.types.contains(std::string(k_picture_topic)));
  EXPECT_TRUE(bare.types.contains(std::string(k_explanation_topic)));
}

}  // namespace
}  // namespace glint::picture_messages_test
