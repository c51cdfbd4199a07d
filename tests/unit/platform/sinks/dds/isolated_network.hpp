// Network namespace with a loopback interface only: no packet of a test leaves or enters it.
#pragma once

#include <gtest/gtest.h>

namespace glint {

// Moves the process into the namespace, once. Returns false if the system forbids it.
[[nodiscard]] bool in_isolated_network();

class DdsTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!in_isolated_network()) GTEST_SKIP() << "no right to make a network of the test's own";
  }
};

}  // namespace glint
