#include "platform/printable.hpp"

#include <gtest/gtest.h>

#include <string>

#include "platform/input_error.hpp"

namespace glint {
namespace {

TEST(Printable, KeepsTextOfAnyLanguage) {
  for (const std::string text : {"", "joint_1",
                                 "Pr\xC3\xBC"
                                 "fling",
                                 "\xE5\xB7\xA5\xE5\x85\xB7", "\xF0\x9F\x96\x8A", "a b"}) {
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, ReplacesControlCharacters) {
  EXPECT_EQ(printable("\x1B]0;title\x07"), "?]0;title?");
  EXPECT_EQ(printable("a\nb\rc\td\x7F"), "a?b?c?d?");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a?b");
  EXPECT_EQ(printable("\xC2\x9B"
                      "31m"),
            "?31m")
      << "CSI as one character (C1)";
}

TEST(Printable, ReplacesCharactersThatTurnOrHideText) {
  EXPECT_EQ(printable("a\xE2\x80\xAE"
                      "b"),
            "a?b")
      << "U+202E";
  EXPECT_EQ(printable("a\xE2\x80\x8B"
                      "b\xEF\xBB\xBF"),
            "a?b?")
      << "U+200B, U+FEFF";
}

TEST(Printable, ReplacesEachByteThatIsNoUtf8) {
  EXPECT_EQ(printable("a\xFF"
                      "b"),
            "a?b");
  EXPECT_EQ(printable("\xC0\xAF"), "??") << "overlong";
  EXPECT_EQ(printable("\xED\xA0\x80"), "???") << "surrogate";
  EXPECT_EQ(printable("\xF4\x90\x80\x80"), "????") << "above U+10FFFF";
  EXPECT_EQ(printable("\xE5\xB7"), "??") << "cut short";
}

TEST(Printable, KeepsTheLinesOfATable) {
  EXPECT_EQ(printable_lines("a\x1B\nb\n"), "a?\nb\n");
  EXPECT_EQ(printable_lines("\n\nx\r"), "\n\nx?");
}

TEST(Printable, MakesMarkupHarmless) {
  EXPECT_EQ(printable_markup("<b a=\"1\">&\x1B</b>"), "&lt;b a=&quot;1&quot;&gt;&amp;?&lt;/b&gt;");
}

TEST(InputErrorTest, IsOneCleanLineOfABoundedLength) {
  EXPECT_STREQ(InputError("arm.urdf: joint '\x1B[2J\n'").what(), "arm.urdf: joint '?[2J?'");
  EXPECT_STREQ(MissingDevice("can\a0").what(), "can?0");
  const std::string line = InputError("file: " + std::string(100'000, 'x') + "; expected y").what();
  EXPECT_LT(line.size(), 2'100u);
  EXPECT_TRUE(line.starts_with("file: ") && line.ends_with("; expected y")) << line;
}

}  // namespace
}  // namespace glint
