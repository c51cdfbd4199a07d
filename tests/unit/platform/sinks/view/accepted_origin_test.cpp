#include "platform/sinks/view/accepted_origin.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace glint {
namespace {

constexpr std::string_view k_loopback = "127.0.0.1:8765";

TEST(AcceptedOrigin, AcceptsThisMachineFoxgloveAndPrograms) {
  for (const std::string_view origin :
       {"", "http://localhost:8080", "http://127.0.0.1", "http://[::1]:9", "https://localhost",
        "https://app.foxglove.dev", "app://foxglove"}) {
    EXPECT_TRUE(is_accepted_origin(origin, k_loopback)) << origin;
  }
}

TEST(AcceptedOrigin, RefusesOtherPages) {
  for (const std::string_view origin :
       {"null", "http://example.org", "https://localhost.example.org",
        "http://127.0.0.1.example.org", "http://app.foxglove.dev.example.org",
        "http://192.168.1.7:8765"}) {
    EXPECT_FALSE(is_accepted_origin(origin, k_loopback)) << origin;
  }
}

TEST(AcceptedOrigin, AcceptsItsOwnPageByAddressNotByName) {
  EXPECT_TRUE(is_accepted_origin("http://192.168.1.7:8765", "192.168.1.7:8765"));
  EXPECT_FALSE(is_accepted_origin("http://192.168.1.7:80", "192.168.1.7:8765"));
  EXPECT_FALSE(is_accepted_origin("http://attacker.example:8765", "attacker.example:8765"));
}

}  // namespace
}  // namespace glint
