#include "platform/formats/points_csv.hpp"

#include <gtest/gtest.h>

#include "platform/input_error.hpp"

namespace glint {
namespace {

std::string error_message_for(const std::string& text) {
  try {
    const auto frames = points_from_text(text, "points.csv");
    return "accepted " + std::to_string(frames.size()) + " frames";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(PointsCsv, MakesAFrameOfTheRowsOfOneTime) {
  const auto frames = points_from_text(
      "time_s,x_m,y_m,z_m\r\n0.5,1,2,3\r\n0.5, 4 ,5,6e-1\r\n\r\n0.5222,-7,8,9\r\n", "points.csv");
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].time.nanoseconds, 500'000'000);
  ASSERT_EQ(frames[0].points_m.size(), 2u);
  EXPECT_EQ(frames[0].points_m[1], Vector3(4, 5, 0.6));
  EXPECT_EQ(frames[1].time.nanoseconds, 522'200'000);
  EXPECT_EQ(frames[1].points_m[0], Vector3(-7, 8, 9));
}

TEST(PointsCsv, NeedsNoHeadingAndNoLastLineEnd) {
  const auto frames = points_from_text("0,1,2,3\n1,4,5,6", "points.csv");
  EXPECT_EQ(frames.size(), 2u);
}

TEST(PointsCsv, NamesTheLineOfWhatItRefuses) {
  EXPECT_EQ(error_message_for("0,1,2,3\n0,1,two,3\n"),
            "points.csv:2: y_m is \"two\"; expected a number from -10000 to 10000");
  EXPECT_EQ(error_message_for("time_s,x_m,y_m,z_m\n0,1,nan,3\n"),
            "points.csv:2: y_m is \"nan\"; expected a number from -10000 to 10000");
  EXPECT_EQ(error_message_for("0,1,2,inf\n"),
            "points.csv:1: z_m is \"inf\"; expected a number from -10000 to 10000");
  EXPECT_EQ(error_message_for("1,1,2,3\n0.9,1,2,3\n"),
            "points.csv:2: time_s decreases; expected rows in order of time");
  EXPECT_EQ(error_message_for("0,1,2\n"),
            "points.csv:1: \"0,1,2\"; expected four columns time_s,x_m,y_m,z_m");
  EXPECT_EQ(error_message_for("0,1,2,3,4\n"),
            "points.csv:1: \"0,1,2,3,4\"; expected four columns time_s,x_m,y_m,z_m");
  EXPECT_EQ(error_message_for("0,1,2,3\ntime_s,x_m,y_m,z_m\n"),
            "points.csv:2: time_s is \"time_s\"; expected a number from -9e+09 to 9e+09");
  EXPECT_EQ(error_message_for("0,1,2,\n"),
            "points.csv:1: z_m is \"\"; expected a number from -10000 to 10000");
  EXPECT_EQ(error_message_for("time_s,x_m,y_m,z_m\n"),
            "points.csv:1: holds no point; expected rows time_s,x_m,y_m,z_m");
  std::string crowd;
  for (int i = 0; i <= k_blobs_max; ++i) crowd += "0,1,2," + std::to_string(i) + "\n";
  EXPECT_EQ(error_message_for(crowd),
            "points.csv:257: more than 256 points at one time; expected at most so many");
}

TEST(PointsCsv, RefusesAFileThatIsNotThere) {
  EXPECT_THROW((void)load_points("/nonexistent/points.csv"), InputError);
  EXPECT_THROW((void)load_points("/"), InputError);
}

TEST(PointsCsv, PutsMarkersWhereThePointsAre) {
  const Markers markers = markers_from_points({Vector3(1, 2, -2), Vector3::Zero()});
  ASSERT_EQ(markers.count, 2);
  EXPECT_EQ(markers.items[0].surface_range_m, 3.0);
  EXPECT_LT((markers.items[0].ray * 3.0 - Vector3(1, 2, -2)).norm(), 1e-15);
  EXPECT_EQ(markers.items[1].flags, k_marker_no_depth);
}

}  // namespace
}  // namespace glint
