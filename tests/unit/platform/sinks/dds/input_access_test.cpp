#include "platform/sinks/dds/input_access.hpp"

#include <gtest/gtest.h>

namespace glint {
namespace {

AllowedInputs allowed(std::initializer_list<DdsInput> inputs) {
  AllowedInputs all;
  for (const DdsInput input : inputs) all.add(input);
  return all;
}

TEST(InputAccess, AdmitsOnlyInputsThatAreNamed) {
  InputAccess access(allowed({DdsInput::buttons}));
  EXPECT_TRUE(access.admits(DdsInput::buttons, Time{}));
  EXPECT_FALSE(access.admits(DdsInput::tools, Time{}));
  EXPECT_FALSE(access.admits(DdsInput::joint_states, Time{}));
  EXPECT_FALSE(access.admits(DdsInput::tools, Time{}));
  EXPECT_EQ(access.refusals().not_allowed,
            (std::array<std::uint64_t, k_dds_inputs>{1, 0, 0, 0, 2}));
  EXPECT_EQ(text_of(access.refusals()), "not allowed by the cell: joint_states 1, tools 2");
}

TEST(InputAccess, RefusesWhatComesFasterThanTheLargestRate) {
  InputAccess access(allowed({DdsInput::tools, DdsInput::buttons}));
  const int rate = InputAccess::k_rates_max[index_of(DdsInput::tools)];
  for (int second = 0; second < 3; ++second) {
    int admitted = 0;
    for (int i = 0; i < 4 * rate; ++i) {
      const Time time = Time{} + milliseconds(2000 * second) + microseconds(i);
      admitted += access.admits(DdsInput::tools, time) ? 1 : 0;
    }
    EXPECT_EQ(admitted, rate);
  }
  EXPECT_TRUE(access.admits(DdsInput::buttons, Time{})) << "each input has a rate of its own";
  const auto refused = static_cast<std::uint64_t>(9 * rate);
  EXPECT_EQ(access.refusals().too_fast[index_of(DdsInput::tools)], refused);
  EXPECT_EQ(text_of(access.refusals()), "too fast: tools " + std::to_string(refused));
}

}  // namespace
}  // namespace glint
