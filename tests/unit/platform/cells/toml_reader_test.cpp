#include "platform/cells/toml_reader.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/unit/platform/calibrate/expect_message.hpp"
#include "tests/unit/platform/cells/complaint.hpp"

namespace glint {
namespace {

using test::complaint_about;
using test::expect_input_error;

// toml++ 3.3.0: an assertion without NDEBUG, undefined behaviour in clang's release build.
TEST(TomlReader, RefusesWhatBreaksTheParserWithItsLine) {
  expect_input_error([] { (void)parse_toml("[\nd", "a.toml"); }, {"a.toml:2: ", "expected TOML"});
  expect_input_error([] { (void)parse_toml("a = 1\n[t]\nb = 2\n[\nd\n[u]\n", "a.toml"); },
                     {"a.toml:5: ", "expected TOML"});
}

TEST(TomlReader, ShowsNoControlCharactersOfTheFile) {
  const std::string complaint = complaint_about("tools = \"\\u001b[2J\"\n");
  EXPECT_NE(complaint, "accepted");
  EXPECT_EQ(complaint.find('\x1b'), std::string::npos) << complaint;
  EXPECT_EQ(complaint_about("\"\\u001b]0;x\\u0007\" = 1\n").find('\x1b'), std::string::npos);
}

TEST(TomlReader, RefusesATextThatIsNotPrintable) {
  EXPECT_NE(complaint_about("[dds]\ninterface = \"l\\u001bo\"\n").find("printable"),
            std::string::npos);
}

// Its rays were read before their number was compared with the picture's.
TEST(TomlReader, RefusesCarriedRaysThatAreTooFew) {
  CellFiles files;
  files.rays = std::make_shared<const std::vector<float>>(3, 1.0f);
  expect_input_error(
      [&] { (void)cell_from_text("[camera]\nray_table = \"a.npy\"\n", "run.mcap", &files); },
      {"run.mcap", "rays.f32 has 3 numbers"});
}

}  // namespace
}  // namespace glint
