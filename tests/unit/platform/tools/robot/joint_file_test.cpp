#include "platform/tools/robot/joint_file.hpp"

#include <gtest/gtest.h>

#include "platform/formats/npy.hpp"
#include "tests/unit/platform/tools/calibrate/expect_message.hpp"
#include "tests/unit/platform/tools/robot/files.hpp"

namespace glint {
namespace {

using test::expect_input_error;
using test::Files;

const std::vector<std::string> k_inputs = {"pan", "lift", "slide"};

std::vector<double> read(const Files& files, const std::string& text) {
  return read_joint_positions(files.write("joints.txt", text), k_inputs);
}

TEST(JointFile, TakesNumbersInOrderOrByName) {
  const Files files;
  EXPECT_EQ(read(files, "0.5 -1e-1\n# a remark\n2"), (std::vector<double>{0.5, -0.1, 2}));
  EXPECT_EQ(read(files, "[0.5, -0.1, 2]"), (std::vector<double>{0.5, -0.1, 2}));
  EXPECT_EQ(read(files, "slide: 2\npan = 0.5\nlift -0.1\n"), (std::vector<double>{0.5, -0.1, 2}));
}

TEST(JointFile, ReadsNumPysArrays) {
  const Files files;
  const std::string path = files.write("q.npy", npy_float32_bytes({{3}, {0.5f, 0.25f, 2}}));
  EXPECT_EQ(read_joint_positions(path, k_inputs), (std::vector<double>{0.5, 0.25, 2}));
}

TEST(JointFile, NamesWhatIsWrong) {
  const Files files;
  expect_input_error([&] { (void)read(files, "1 2"); }, {"joints.txt", "expected 3", "lift"});
  expect_input_error([&] { (void)read(files, "1 2 3 4"); }, {"4 positions", "expected 3"});
  expect_input_error([&] { (void)read(files, "1\n2\nnan"); }, {"joints.txt:3", "finite"});
  expect_input_error([&] { (void)read(files, "1 2 1e7"); }, {"joints.txt:1", "finite"});
  expect_input_error([&] { (void)read(files, "pan 1\nlift 2\nelbow 3"); },
                     {"joints.txt:3", "elbow"});
  expect_input_error([&] { (void)read(files, "pan 1\npan 2\nlift 3"); }, {"joints.txt:2", "twice"});
  expect_input_error([&] { (void)read(files, "pan 1\nlift 3"); }, {"'slide'"});
  expect_input_error([&] { (void)read(files, "pan one"); }, {"joints.txt:1", "'one'"});
  expect_input_error([&] { (void)read_joint_positions(files.folder() + "/no.txt", k_inputs); },
                     {"no.txt", "cannot be read"});
}

}  // namespace
}  // namespace glint
