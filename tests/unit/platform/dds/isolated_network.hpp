// A network of the test's own: a loopback interface and nothing else, so that no packet of a test
// leaves it and nothing from outside disturbs it.
#pragma once

#include <gtest/gtest.h>

namespace glint {

// Enters it with the whole process, once; false where the machine forbids it.
[[nodiscard]] bool in_isolated_network();

class DdsTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!in_isolated_network()) GTEST_SKIP() << "no right to make a network of the test's own";
  }
};

}  // namespace glint
