// ROS messages, interpolation of transforms, and compressed chunks.
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <zstd.h>

#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "platform/cells/calibration_files.hpp"
#include "platform/input_error.hpp"
#include "platform/sinks/record/cdr.hpp"
#include "platform/sources/chunk_decoder.hpp"
#include "platform/sources/ros_images.hpp"
#include "platform/sources/transform_tree.hpp"

namespace glint {
namespace {

void put_header(CdrWriter& to, std::int32_t seconds, std::uint32_t nanoseconds,
                const char* frame = "ir") {
  to.put(seconds);
  to.put(nanoseconds);
  to.put(frame);
}

Bytes image_message(std::uint32_t width, std::uint32_t height, const char* encoding,
                    bool big_endian, std::uint32_t step, const Bytes& rows) {
  CdrWriter to;
  put_header(to, 3, 7);
  to.put(height);
  to.put(width);
  to.put(encoding);
  to.put(static_cast<std::uint8_t>(big_endian));
  to.put(step);
  to.put_bytes(rows);
  return {to.bytes().begin(), to.bytes().end()};
}

std::vector<std::uint16_t> values_of(const Bytes& message, double unit_m = 0.001) {
  return ros_image_of(message, unit_m, "/a").plane.values;
}

using Values = std::vector<std::uint16_t>;

// Each row has two bytes of padding.
TEST(RosImage, ReadsEachEncoding) {
  const Bytes bytes{1, 2, 99, 99, 3, 4, 99, 99};
  EXPECT_EQ(values_of(image_message(2, 2, "mono8", false, 4, bytes)), (Values{1, 2, 3, 4}));
  EXPECT_EQ(values_of(image_message(2, 2, "8UC1", false, 4, bytes)), (Values{1, 2, 3, 4}));
  EXPECT_EQ(values_of(image_message(1, 2, "mono16", false, 4, bytes)), (Values{0x201, 0x403}));
  EXPECT_EQ(values_of(image_message(1, 2, "16UC1", true, 4, bytes)), (Values{0x102, 0x304}));
  Bytes floats;
  for (const float metres : {0.25f, NAN, -1.0f, 70.0f, 0.00026f}) {
    append(floats, std::bit_cast<std::uint32_t>(metres));
  }
  EXPECT_EQ(values_of(image_message(5, 1, "32FC1", false, 20, floats)), (Values{250, 0, 0, 0, 0}));
  EXPECT_EQ(values_of(image_message(5, 1, "32FC1", false, 20, floats), 1e-4),
            (Values{2500, 0, 0, 0, 3}));
  const RosImage image = ros_image_of(image_message(2, 2, "mono8", false, 4, bytes), 1, "/a");
  EXPECT_EQ(image.header.stamp.nanoseconds, 3'000'000'007);
  EXPECT_EQ(image.header.frame, "ir");
  EXPECT_EQ(image.plane.width, 2);
  EXPECT_EQ(image.plane.height, 2);
}

std::string refusal_of(const Bytes& message) {
  try {
    (void)values_of(message);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(RosImage, RefusesWhatIsNoImage) {
  const Bytes four(4);
  EXPECT_NE(refusal_of(image_message(2, 2, "bgr8", false, 2, four)).find("/a: encoding \"bgr8\""),
            std::string::npos);
  for (const Bytes& message :
       {image_message(2, 2, "mono16", false, 2, four), image_message(2, 3, "mono8", false, 2, four),
        image_message(0x80000000, 2, "mono16", false, 2, four),
        image_message(2, 0x80000001, "mono8", false, 2, four)}) {
    EXPECT_NE(refusal_of(message).find("bytes a row"), std::string::npos) << refusal_of(message);
  }
  Bytes cut = image_message(2, 2, "mono8", false, 2, four);
  cut.pop_back();
  EXPECT_NE(refusal_of(cut).find("incomplete"), std::string::npos);
}

Bytes info_message(const char* model, const std::vector<double>& d, double fx = 250,
                   std::uint32_t binning = 0) {
  CdrWriter to;
  put_header(to, 0, 0);
  to.put(std::uint32_t{240});
  to.put(std::uint32_t{320});
  to.put(model);
  to.put_length(d.size());
  for (const double value : d) to.put(value);
  const double k[9] = {fx, 0, 160.25, 0, fx + 1, 119.5, 0, 0, 1};
  for (const double value : k) to.put(value);
  for (int i = 0; i < 9 + 12; ++i) to.put(0.0);
  for (int i = 0; i < 6; ++i) to.put(i == 0 ? binning : 0u);
  to.put(false);
  return {to.bytes().begin(), to.bytes().end()};
}

CameraModel lens_of_info(const Bytes& message) {
  CameraModel size;
  size.width = 320;
  size.height = 240;
  return lens_of({"camera.file", "bag:/info", lens_text_of_camera_info(message, "/info")}, size);
}

// The reference is OpenCV's formulas, written out here, with pixel centres at integers.
TEST(CameraInfo, ProjectsAsRosDocumentsIt) {
  const std::vector<double> plumb_bob{-0.2, 0.05, 0.001, -0.002, 0.01};
  const std::vector<double> rational{0.4, 0.1, 0.001, -0.002, 0.01, 0.7, 0.2, 0.03};
  for (const auto& [model, d] :
       {std::pair{"plumb_bob", plumb_bob}, std::pair{"rational_polynomial", rational}}) {
    const CameraModel lens = lens_of_info(info_message(model, d));
    const Vector3 point(0.11, -0.07, 0.4);
    const double x = point.x() / point.z(), y = point.y() / point.z(), r2 = x * x + y * y;
    const auto k = [&numbers = d](std::size_t i) { return i < numbers.size() ? numbers[i] : 0.0; };
    const double radial = (1 + k(0) * r2 + k(1) * r2 * r2 + k(4) * r2 * r2 * r2) /
                          (1 + k(5) * r2 + k(6) * r2 * r2 + k(7) * r2 * r2 * r2);
    const double u = x * radial + 2 * k(2) * x * y + k(3) * (r2 + 2 * x * x);
    const double v = y * radial + k(2) * (r2 + 2 * y * y) + 2 * k(3) * x * y;
    const Result<Vector2> pixel = project(lens, point);
    ASSERT_EQ(pixel.reason, Reason::none) << model;
    EXPECT_NEAR(pixel.value.x(), 250 * u + 160.25 + 0.5, 1e-9) << model;
    EXPECT_NEAR(pixel.value.y(), 251 * v + 119.5 + 0.5, 1e-9) << model;
  }
}

// A barrel distortion has a maximum field angle: beyond it the polynomial decreases.
TEST(CameraInfo, EndsTheFieldWhereTheDistortionTurnsBack) {
  const CameraModel lens = lens_of_info(info_message("plumb_bob", {-0.9, 0, 0, 0, 0}, 60));
  EXPECT_NEAR(lens.field_tangent_max, std::sqrt(1 / (3 * 0.9)), 2e-3);
  const CameraModel mild = lens_of_info(info_message("plumb_bob", {0, 0, 0, 0, 0}));
  const double corner = std::hypot((160.25 + 1) / 250, 240 - 119.5 > 120.5 ? 0 : 120.5 / 251);
  EXPECT_NEAR(mild.field_tangent_max, corner, 2e-3);
}

TEST(CameraInfo, RefusesWhatIsNoLens) {
  for (const auto& [message, part] :
       {std::pair{info_message("equidistant", {0, 0, 0, 0}), "plumb_bob with 5"},
        std::pair{info_message("plumb_bob", {0, 0, 0, 0, 0}, 0), "no calibration"},
        std::pair{info_message("plumb_bob", {NAN, 0, 0, 0, 0}), "no calibration"},
        std::pair{info_message("plumb_bob", {0, 0, 0, 0, 0}, 250, 2), "binning"},
        std::pair{info_message("plumb_bob", std::vector<double>(65)), "incomplete"}}) {
    try {
      (void)lens_text_of_camera_info(message, "/info");
      ADD_FAILURE() << part;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
}

Pose turned_about_z(double angle, double x) {
  return {Quaternion(std::cos(angle / 2), 0, 0, std::sin(angle / 2)), Vector3(x, 0, 0)};
}

TEST(TransformTree, InterpolatesAndMultipliesAlongTheChain) {
  TransformTree tree;
  tree.add("rig", "camera", {}, {Quaternion::Identity(), Vector3(0, 0, 1)}, true);
  tree.add("map", "rig", Time{2'000'000}, turned_about_z(0.02, 2), false);  // out of time order
  tree.add("map", "rig", Time{1'000'000}, turned_about_z(0.01, 1), false);
  EXPECT_EQ(tree.root_of("camera"), "map");
  const auto pose = tree.at("map", "camera", Time{1'250'000});
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->translation.x(), 1.25, 1e-12);
  EXPECT_NEAR(pose->translation.z(), 1, 1e-12);
  EXPECT_NEAR(2 * std::atan2(pose->rotation.z(), pose->rotation.w()), 0.0125, 1e-8);
  // Both signs of a quaternion are the same rotation.
  TransformTree other;
  Pose negative = turned_about_z(0.02, 0);
  negative.rotation.coeffs() *= -1;
  other.add("map", "rig", Time{0}, turned_about_z(0.01, 0), false);
  other.add("map", "rig", Time{1000}, negative, false);
  EXPECT_NEAR(
      std::abs(other.at("map", "rig", Time{500})->rotation.dot(turned_about_z(0.015, 0).rotation)),
      1, 1e-12);
}

TEST(TransformTree, HasNothingOutsideItsTimesAndOverLongGaps) {
  TransformTree tree;
  tree.add("map", "rig", Time{0}, {}, false);
  tree.add("map", "rig", Time{} + k_transform_gap_max, {}, false);
  tree.add("map", "rig", Time{1} + k_transform_gap_max * 2, {}, false);
  EXPECT_TRUE(tree.at("map", "rig", Time{0}));
  EXPECT_TRUE(tree.at("map", "rig", Time{5}));
  EXPECT_FALSE(tree.at("map", "rig", Time{-1}));
  EXPECT_FALSE(tree.at("map", "rig", Time{5} + k_transform_gap_max));
  EXPECT_FALSE(tree.at("map", "rig", Time{2} + k_transform_gap_max * 2));
  EXPECT_FALSE(tree.at("other", "rig", Time{0}));
}

// Two branches of one tree; transforms above their common ancestor are not needed.
TEST(TransformTree, GoesDownAnotherBranch) {
  TransformTree tree;
  tree.add("odom", "base", {}, {Quaternion::Identity(), Vector3(1, 0, 0)}, true);
  tree.add("odom", "table", {}, {Quaternion::Identity(), Vector3(0, 2, 0)}, true);
  tree.add("map", "odom", Time{9}, {}, false);
  EXPECT_EQ(tree.at("base", "table", Time{9})->translation, Vector3(-1, 2, 0));
  EXPECT_EQ(tree.at("odom", "table", Time{100})->translation, Vector3(0, 2, 0));
}

TEST(TransformTree, StatesUpToWhenItHasAllTransforms) {
  TransformTree tree;
  tree.add("rig", "camera", {}, {}, true);
  tree.add("map", "rig", Time{7}, {}, false);
  tree.add("world", "map", Time{5}, {}, false);
  EXPECT_EQ(tree.available_until("map", "camera"), Time{7}) << "what stands above has no part";
  EXPECT_EQ(tree.available_until("world", "camera"), Time{5});
  EXPECT_FALSE(tree.available_until("elsewhere", "camera"));
}

TEST(TransformTree, KeepsTheNewestOfATreeWithoutEnd) {
  TransformTree tree(TransformHistory::newest);
  const auto at_ms = [](std::int64_t ms) { return Time{} + milliseconds(ms); };
  for (int i = 0; i < 10'000; ++i) tree.add("map", "rig", at_ms(i), turned_about_z(0, i), false);
  EXPECT_NEAR(tree.at("map", "rig", at_ms(9'700))->translation.x(), 9'700, 1e-9);
  EXPECT_FALSE(tree.at("map", "rig", at_ms(100)));
  tree.add("map", "rig", at_ms(0), turned_about_z(0, 1), false);  // a clock that restarted
  tree.add("map", "rig", at_ms(2), turned_about_z(0, 3), false);
  EXPECT_NEAR(tree.at("map", "rig", at_ms(1))->translation.x(), 2, 1e-9);
  EXPECT_EQ(tree.available_until("map", "rig"), at_ms(2));
  for (std::size_t i = 0; i < 2 * k_live_links; ++i) {
    tree.add("map", std::to_string(i), {}, {}, true);
  }
  EXPECT_EQ(tree.refused(), k_live_links + 1);
}

TEST(TransformTree, RefusesWhatIsNoTree) {
  TransformTree tree;
  tree.add("a", "b", {}, {}, true);
  tree.add("b", "a", {}, {}, true);  // a loop: no root; the search ends
  EXPECT_FALSE(tree.at("c", "a", {}));
  tree.add("c", "b", {}, {}, true);  // a second parent
  Pose bad;
  bad.rotation.coeffs() *= 2;
  tree.add("x", "y", {}, bad, true);
  bad = {Quaternion::Identity(), Vector3(NAN, 0, 0)};
  tree.add("x", "y", {}, bad, true);
  EXPECT_EQ(tree.refused(), 3u);
  EXPECT_FALSE(tree.has("y"));
}

Bytes some_records() {
  Bytes bytes(10'000);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * i / 97);
  return bytes;
}

TEST(ChunkDecoder, DecodesWhatTheLibrariesCompress) {
  const Bytes records = some_records();
  Bytes zstd(ZSTD_compressBound(records.size()));
  zstd.resize(ZSTD_compress(zstd.data(), zstd.size(), records.data(), records.size(), 1));
  Bytes lz4(LZ4F_compressFrameBound(records.size(), nullptr));
  lz4.resize(LZ4F_compressFrame(lz4.data(), lz4.size(), records.data(), records.size(), nullptr));
  for (const auto& [name, from] : {std::pair{"zstd", zstd}, std::pair{"lz4", lz4}}) {
    Bytes to(records.size());
    EXPECT_TRUE(decode_chunk(name, from, to)) << name;
    EXPECT_EQ(to, records) << name;
    for (const std::size_t size : {records.size() - 1, records.size() + 1}) {
      to.resize(size);
      EXPECT_FALSE(decode_chunk(name, from, to)) << name << size;
    }
    to.resize(records.size());
    const std::span<const std::uint8_t> cut(from.data(), from.size() - 5);
    EXPECT_FALSE(decode_chunk(name, cut, to)) << name;
    EXPECT_FALSE(decode_chunk("bz2", from, to));
    EXPECT_FALSE(decode_chunk(name, {}, to));
  }
}

}  // namespace
}  // namespace glint
