#include "platform/cells/toml_reader.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/unit/platform/cells/error_message.hpp"
#include "tests/unit/platform/tools/calibrate/expect_message.hpp"

namespace glint {
namespace {

using test::error_message_for;
using test::expect_input_error;

// toml++ 3.3.0: assertion failure without NDEBUG, undefined behaviour in clang's release build.
TEST(TomlReader, RefusesWhatBreaksTheParserWithItsLine) {
  expect_input_error([] { (void)parse_toml("[\nd", "a.toml"); }, {"a.toml:1: ", "expected TOML"});
  expect_input_error([] { (void)parse_toml("a = 1\n[t]\nb = 2\n[\nd\n[u]\n", "a.toml"); },
                     {"a.toml:4: ", "expected TOML"});
}

std::string repeated(const std::string& piece, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += piece;
  return text;
}

// toml++ 3.3.0: undefined behaviour at a non-ASCII letter where white space is allowed.
TEST(TomlReader, RefusesLettersOfOtherLanguagesOutsideOfTexts) {
  expect_input_error([] { (void)parse_toml("a = 1\nb = 2 \xC3\xA9\n", "a.toml"); },
                     {"a.toml:2: ", "expected TOML"});
  expect_input_error([] { (void)parse_toml("\xD0\xB6 = 1\n", "a.toml"); }, {"a.toml:1: "});
  EXPECT_EQ(parse_toml("a = \"\xC3\xA9\" # \xC3\xA9\n", "a").size(), 1u);
}

// A key of a million parts caused SIGSEGV: toml++ destroys nested tables by recursion.
TEST(TomlReader, BoundsTheDepthOfTables) {
  const auto refused = [](const std::string& text, const char* place) {
    expect_input_error([&] { (void)parse_toml(text, "a.toml"); }, {place});
  };
  const std::string deep = repeated("a.", 70) + "b = 1\n";
  refused("x = 1\n" + repeated("a.", 1'000'000) + "b = 1\n", "a.toml:2: a key of more than 64");
  refused("[" + repeated("a . ", 70) + "b]\n", "a key of more");
  refused(repeated("'='.\"\\\"\".", 40) + "b = 1\n", "a key of more");
  refused("s = \"\"\"x\"\"\"\"\"\n" + deep, "a.toml:2: a key of more");
  refused("s = '''x'''''\n" + deep, "a.toml:2: a key of more");
  refused("a = " + repeated("[", 100) + repeated("]", 100), "expected TOML");
}

TEST(TomlReader, TakesDotsThatAreNoKeys) {
  const std::string dots = repeated(".", 200);
  const std::string text =
      "a = \"" + dots + "\" # " + dots + "\n# " + dots + "\nb = '" + dots + "'\n";
  EXPECT_EQ(parse_toml(text, "a").size(), 2u);
  EXPECT_EQ(parse_toml("a = [" + repeated("1.5, ", 200) + "]\n", "a").size(), 1u);
  EXPECT_EQ(parse_toml(repeated("a.", 60) + "b = 1\n", "a").size(), 1u);
}

TEST(TomlReader, ShowsNoControlCharactersOfTheFile) {
  const std::string message = error_message_for("tools = \"\\u001b[2J\"\n");
  EXPECT_NE(message, "accepted");
  EXPECT_EQ(message.find('\x1b'), std::string::npos) << message;
  EXPECT_EQ(error_message_for("\"\\u001b]0;x\\u0007\" = 1\n").find('\x1b'), std::string::npos);
}

TEST(TomlReader, RefusesATextThatIsNotPrintable) {
  EXPECT_NE(error_message_for("[dds]\ninterface = \"l\\u001bo\"\n").find("printable"),
            std::string::npos);
}

// An earlier version read the rays before it compared their number with the image size.
TEST(TomlReader, RefusesCarriedRaysThatAreTooFew) {
  CellFiles files;
  files.rays = std::make_shared<const std::vector<float>>(3, 1.0f);
  expect_input_error(
      [&] { (void)cell_from_text("[camera]\nray_table = \"a.npy\"\n", "run.mcap", &files); },
      {"run.mcap", "rays.f32 has 3 numbers"});
}

}  // namespace
}  // namespace glint
