#include "master/lcm/printable_text.hpp"

#include <gtest/gtest.h>
#include <string>

namespace takt {
namespace {

TEST(PrintableText, LeavesOrdinaryTextAsItIs) {
  EXPECT_EQ(printable_text("node 5: Überlauf, 5 µm, 日本, \U0001F600"),
            "node 5: Überlauf, 5 µm, 日本, \U0001F600");
}

TEST(PrintableText, LetsNoControlCharacterThrough) {
  EXPECT_EQ(printable_text("\x1B[2J\x1B]0;title\x07"), "?[2J?]0;title?");
  EXPECT_EQ(printable_text(std::string_view{"a\0b\tc\nd\re\x7F", 10}), "a?b?c?d?e?");
  EXPECT_EQ(printable_text("\xC2\x9B"
                           "2J"),
            "?2J");  // CSI as UTF-8
  EXPECT_EQ(printable_text("\x9B"
                           "2J"),
            "?2J");  // CSI of 8-bit terminals
  EXPECT_EQ(printable_text("a\xE2\x80\xAE"
                           "b"),
            "a?b");  // reverses the direction of writing
  EXPECT_EQ(printable_text("a\xE2\x80\xA8"
                           "b"),
            "a?b");  // a line separator
}

TEST(PrintableText, KeepsLinesWhereThereMayBeSeveral) {
  EXPECT_EQ(printable_lines("a\x1B\n\nb\r\n"), "a?\n\nb?\n");
}

TEST(PrintableText, ReplacesBytesThatAreNoUtf8) {
  EXPECT_EQ(printable_text("\xC3"), "?");
  EXPECT_EQ(printable_text("\xC0\x8A"), "??");            // a line feed in two bytes
  EXPECT_EQ(printable_text("\xED\xA0\x80"), "???");       // half of a surrogate pair
  EXPECT_EQ(printable_text("\xF4\x90\x80\x80"), "????");  // beyond Unicode
}

}  // namespace
}  // namespace takt
