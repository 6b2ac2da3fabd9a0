#include <gtest/gtest.h>
#include <sstream>

#include "eds_parser/print/print_dictionary.hpp"
#include "eds_parser/read/compact.hpp"
#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

std::string repeated(std::string_view piece, std::size_t bytes) {
  std::string text;
  text.reserve(bytes + piece.size());
  while (text.size() < bytes) text += piece;
  return text;
}

/// Reads and checks a text. The report must stay small for any text.
EdsFile survive(const std::string& text) {
  auto file = read_eds(text, "hostile.eds", 5_node);
  EXPECT_LT(file.findings.size(), 20'000U);
  EXPECT_LT(check(file.dictionary).size(), 40'000U);
  return file;
}

constexpr std::size_t megabyte = 1 << 20;

TEST(Hostile, BracketsWithoutEnd) {
  EXPECT_FALSE(survive(repeated("[", 10 * megabyte)).readable);
  EXPECT_FALSE(survive(repeated("[\n", 10 * megabyte)).readable);
  EXPECT_FALSE(survive(repeated("[]", 10 * megabyte)).readable);
  EXPECT_FALSE(survive(repeated("[]\n", 10 * megabyte)).readable);
}

TEST(Hostile, OneLineOfManyMegabytes) {
  EXPECT_TRUE(survive("[1000]\nDefaultValue=" + repeated("1", 3 * megabyte)).readable);
  EXPECT_TRUE(survive("[1000]\nDefaultValue=" + repeated("1+", 3 * megabyte)).readable);
  EXPECT_TRUE(survive("[1000]\nDefaultValue=" + repeated("$NODEID+", 3 * megabyte)).readable);
  EXPECT_TRUE(survive("[1000]\nParameterName=" + repeated("\xFF", 3 * megabyte)).readable);
  EXPECT_TRUE(survive("[1000]\n" + repeated("=", 3 * megabyte)).readable);
}

TEST(Hostile, CarriageReturnsOnly) {
  EXPECT_FALSE(survive(repeated("\r", 10 * megabyte)).readable);
  EXPECT_TRUE(survive("[1000]\r" + repeated("x=1\r", 10 * megabyte)).readable);
}

TEST(Hostile, TheSameSectionAndKeyForever) {
  EXPECT_TRUE(survive(repeated("[1000sub1]\nDataType=5\n", 5 * megabyte)).readable);
  std::string text = "[1000]\n";
  for (int i = 0; i < 300'000; ++i) text += "DefaultValue=" + std::to_string(i) + "\n";
  EXPECT_TRUE(survive(text).readable);
}

TEST(Hostile, LongListsOfNothing) {
  EXPECT_FALSE(survive("[OptionalObjects]\n" + repeated("1=0x2000\n", 5 * megabyte)).readable);
  EXPECT_FALSE(survive("[2000Name]\n" + repeated("1=x\n", 5 * megabyte)).readable);
  EXPECT_TRUE(
      survive("[2000]\nDataType=7\n[2000Name]\n" + repeated("1=x\n", 5 * megabyte)).readable);
}

TEST(Hostile, CompactSubObjEverywhere) {
  std::string text;
  for (unsigned index = 0x2000; index < 0x6000; ++index) {
    text += "[" + hex(index).substr(2) +
            "]\nParameterName=x\nObjectType=8\nDataType=5\nAccessType=rw\nCompactSubObj=255\n";
  }
  const auto file = survive(text);

  std::size_t subs = 0;
  for (const auto& object : file.dictionary.objects) subs += object.subs.size();
  EXPECT_LE(subs, ExpansionBudget::most);
  EXPECT_GT(subs, ExpansionBudget::most / 2);
  EXPECT_TRUE(test::has(file.findings, "too-many-sub-objects"));
}

TEST(Hostile, CompactPdoWithTheHighestNumbers) {
  const auto file = survive(
      "[DeviceInfo]\nCompactPDO=255\nNrOfRXPDO=65535\nNrOfTXPDO=65535\n"
      "[1000]\nDataType=7\n");

  EXPECT_EQ(file.dictionary.objects.size(), 1U + 4 * 512);
}

TEST(Hostile, JsonOfAnyBytesIsJson) {
  std::string text = "[1000]\nDataType=0x0009\nParameterName=";
  for (int byte = 1; byte < 256; ++byte) {
    if (byte != '\n' && byte != '\r') text += static_cast<char>(byte);
  }
  const auto file = survive(text + "\nDefaultValue=\"\\\x80\xE4\x01\n");
  std::ostringstream out;
  print_json(out, file.dictionary, file.findings);
  print_text(out, file.dictionary);

  EXPECT_NE(out.str().find(R"("default":"\"\\\u20ac\u00e4)"), std::string::npos) << out.str();
}

}  // namespace
}  // namespace takt
