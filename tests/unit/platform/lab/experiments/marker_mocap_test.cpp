#include "platform/lab/experiments/marker_mocap.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "platform/input_error.hpp"

namespace glint {
namespace {

TEST(MarkerMocap, RefusesAFolderWithoutTrialsOrWithoutAGeometry) {
  CaseOptions options;
  options.data = testing::TempDir() + "marker_mocap_" + std::to_string(getpid());
  std::filesystem::create_directories(options.data);
  EXPECT_THROW((void)run_marker_mocap(options), InputError);
  std::ofstream(options.data + "/a_probing.c3d") << "no trial";
  EXPECT_THROW((void)run_marker_mocap(options), InputError);
  std::ofstream(options.data + "/ktk_probe_geometry.csv") << "name,x,y,z\nProbe1,0,zero,0\n";
  EXPECT_THROW((void)run_marker_mocap(options), InputError);
  std::filesystem::remove_all(options.data);
}

TEST(MarkerMocapData, FindsTheProbeWithin02MmAndItsTipOnTheLandmark) {
  const char* data = std::getenv("GLINT_TEST_DATA");
  CaseOptions options;
  options.data = std::string(data == nullptr ? "" : data) + "/marker_mocap";
  if (!std::filesystem::exists(options.data)) {
    GTEST_SKIP() << "no " << options.data << "; set GLINT_TEST_DATA";
  }
  options.out = testing::TempDir() + "marker_mocap_out_" + std::to_string(getpid());
  std::filesystem::create_directories(options.out);
  const CaseList list = run_marker_mocap(options);
  std::fputs(case_table(list).c_str(), stdout);
  EXPECT_EQ(missed_bars(list), 0);
  EXPECT_NE(list.plots.at(0).svg.find("<svg"), std::string::npos);
  std::filesystem::remove_all(options.out);
}

}  // namespace
}  // namespace glint
