#include "platform/sinks/dds/reader_result.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "platform/input_error.hpp"

namespace glint {
namespace {

class ReaderResults : public testing::Test {
 protected:
  ~ReaderResults() override { std::remove(file.c_str()); }
  const std::string file =
      testing::TempDir() + "glint_reader_result_" + std::to_string(getpid()) + ".json";
};

TEST_F(ReaderResults, ComeBackAsTheyWereSaved) {
  ReaderResult result;
  result.received = 1;
  result.missed = 2;
  result.poses_received = 3;
  result.poses_expected = 4;
  result.first_tick = 5;
  result.last_tick = 6;
  result.streams = 7;
  result.streams_ended = 8;
  result.latency_p50_us = 9.5;
  result.latency_p99_us = 10.5;
  result.latency_max_us = 11.5;
  save_result(result, file);
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
  const ReaderResult back = load_result(file);
  EXPECT_EQ(back.received, 1u);
  EXPECT_EQ(back.missed, 2u);
  EXPECT_EQ(back.poses_received, 3u);
  EXPECT_EQ(back.poses_expected, 4u);
  EXPECT_EQ(back.first_tick, 5u);
  EXPECT_EQ(back.last_tick, 6u);
  EXPECT_EQ(back.streams, 7u);
  EXPECT_EQ(back.streams_ended, 8u);
  EXPECT_EQ(back.latency_p50_us, 9.5);
  EXPECT_EQ(back.latency_p99_us, 10.5);
  EXPECT_EQ(back.latency_max_us, 11.5);
}

TEST_F(ReaderResults, ThatAreNoneAreRefusedByName) {
  for (const char* text : {"", "{}", "[1]", "{\"received\": \"many\"}"}) {
    std::ofstream(file) << text;
    try {
      (void)load_result(file);
      FAIL() << "took '" << text << "' for a result";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(file), std::string::npos);
    }
  }
  EXPECT_THROW((void)load_result("/nowhere/reader.json"), InputError);
  EXPECT_THROW(save_result({}, "/nowhere/reader.json"), InputError);
}

}  // namespace
}  // namespace glint
