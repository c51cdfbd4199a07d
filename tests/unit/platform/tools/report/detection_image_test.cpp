#include "platform/tools/report/detection_image.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <vector>

#include "platform/formats/image_file.hpp"
#include "platform/input_error.hpp"
#include "tests/unit/platform/formats/temporary_folder.hpp"

namespace glint {
namespace {

using test::message_of;
using test::TemporaryFolder;

struct Scene {
  std::vector<std::uint16_t> pixels = std::vector<std::uint16_t>(64 * 48, 100);
  Frame frame;
  Rois rois;
  std::unique_ptr<Blobs> blobs = std::make_unique<Blobs>();
  std::unique_ptr<Markers> markers = std::make_unique<Markers>();
  Scene() { frame.reflectivity_16 = {pixels.data(), 64, 48}; }
};

int coloured(const Image& picture) {
  int count = 0;
  for (std::size_t i = 0; i < picture.values.size(); i += 3) {
    const std::uint16_t* pixel = picture.values.data() + i;
    count += pixel[0] != pixel[1] || pixel[1] != pixel[2];
  }
  return count;
}

TEST(Picture, DrawsRoisAndBlobsInColourOnTheGreyFrame) {
  const TemporaryFolder folder;
  Scene scene;
  const std::string path = folder.path("p.png");
  write_detection_image(path, scene.frame, scene.rois, *scene.blobs, *scene.markers, {});
  const Image plain = read_png(path, "");
  ASSERT_EQ(plain.width, 128);
  ASSERT_EQ(plain.height, 96);
  EXPECT_EQ(coloured(plain), 0);

  scene.rois.items[0] = {4, 4, 60, 40};
  scene.rois.count = 1;
  scene.blobs->items[0].centroid_px = {30.5, 20.5};
  scene.blobs->items[0].x0 = 28;
  scene.blobs->items[0].x1 = 33;
  scene.blobs->count = 1;
  const std::vector<std::string> lines{"tools: none", "blobs: 1"};
  write_detection_image(path, scene.frame, scene.rois, *scene.blobs, *scene.markers, lines);
  const Image drawn = read_png(path, "");
  EXPECT_EQ(drawn.width, 128);
  EXPECT_GT(drawn.height, 96 + 2 * 16);
  EXPECT_GT(coloured(drawn), 200);
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
}

TEST(Picture, ShowsADimRoomBesideABrightMarker) {
  const TemporaryFolder folder;
  Scene scene;
  scene.pixels[20 * 64 + 30] = 60000;
  write_detection_image(folder.path("p.png"), scene.frame, scene.rois, *scene.blobs, *scene.markers,
                        {});
  const Image picture = read_png(folder.path("p.png"), "");
  EXPECT_GT(picture.values[3 * (10 * 128 + 10)], 50);
}

TEST(Picture, RefusesAPathThatCannotBeWritten) {
  const Scene scene;
  const TemporaryFolder folder;
  std::ofstream(folder.path("file"));
  const std::string path = folder.path("file/p.png");
  const std::string message = message_of<InputError>([&] {
    write_detection_image(path, scene.frame, scene.rois, *scene.blobs, *scene.markers, {});
  });
  EXPECT_EQ(message.rfind(path + ": cannot be written", 0), 0u) << message;
  EXPECT_NE(message_of<InputError>([&] {
              write_detection_image("p.png", Frame{}, scene.rois, *scene.blobs, *scene.markers, {});
            }),
            "");
}

}  // namespace
}  // namespace glint
