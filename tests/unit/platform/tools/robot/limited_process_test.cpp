#include "platform/tools/robot/limited_process.hpp"

#include <gtest/gtest.h>

#include "platform/input_error.hpp"

namespace glint {
namespace {

ProcessOutput shell(const std::string& script, const ProcessLimits& limits) {
  return output_of({"/bin/sh", "-c", script}, limits);
}

constexpr Duration k_long = milliseconds(600'000);

TEST(LimitedProcess, TakesAllOfTheOutput) {
  const ProcessOutput output = shell("printf abc; printf %070000d 1 >&2; printf def", {6, k_long});
  EXPECT_EQ(output.end, ProcessEnd::done);
  EXPECT_EQ(output.bytes, "abcdef");
}

TEST(LimitedProcess, TellsFailureFromACrash) {
  EXPECT_EQ(shell("exit 3", {10, k_long}).end, ProcessEnd::failed);
  EXPECT_EQ(shell("kill -SEGV $$", {10, k_long}).end, ProcessEnd::killed);
}

TEST(LimitedProcess, EndsOneThatRunsTooLong) {
  EXPECT_EQ(shell("while :; do :; done", {10, milliseconds(50)}).end, ProcessEnd::timed_out);
  EXPECT_EQ(shell("exec >&-; while :; do :; done", {10, milliseconds(50)}).end,
            ProcessEnd::timed_out)
      << "it closed its output and runs on";
}

TEST(LimitedProcess, EndsOneThatWritesTooMuch) {
  EXPECT_EQ(shell("while :; do printf 0123456789; done", {1000, k_long}).end, ProcessEnd::too_much);
}

TEST(LimitedProcess, NamesAProgramThatIsNotThere) {
  EXPECT_THROW((void)output_of({"/no/such/program"}, {10, k_long}), MissingDevice);
}

}  // namespace
}  // namespace glint
