#include "eds_parser/ini/ini.hpp"

#include <gtest/gtest.h>

#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

struct Read {
  explicit Read(std::string_view text) : report{"t"}, file{read_ini(text, report)} {}
  IniEntries entries(std::size_t section) const { return file.entries(file.sections[section]); }
  Report report;
  IniFile file;
};

TEST(Ini, KeepsNamesKeysValuesAndTheirPlaces) {
  Read read{"; comment\n[One]\nkey=value\n  spaced = a = b ;c  \n\n[Two]\n"};

  ASSERT_EQ(read.file.sections.size(), 2U);
  EXPECT_EQ(read.file.sections[0].name, "One");
  EXPECT_EQ(read.file.sections[0].pos, (SourcePos{2, 1}));
  const auto entries = read.entries(0);
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[0].pos(), (SourcePos{3, 5}));
  EXPECT_EQ(entries[1].key, "spaced");
  EXPECT_EQ(entries[1].key_pos(), (SourcePos{4, 3}));
  EXPECT_EQ(entries[1].value, "a = b ;c");
  EXPECT_TRUE(read.entries(1).empty());
  EXPECT_TRUE(read.report.take().empty());
}

TEST(Ini, TakesEveryLineEnd) {
  Read read{"[a]\r\nx=1\ry=2\n\rz=3"};

  const auto entries = read.entries(0);
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_EQ(entries[0].line, 2U);
  EXPECT_EQ(entries[1].line, 3U);
  EXPECT_EQ(entries[2].line, 5U);
  EXPECT_EQ(entries[2].value, "3");
}

TEST(Ini, TakesLinesWhereverTheyBegin) {
  for (std::size_t length = 0; length < 200; ++length) {
    const std::string key(length, 'k');
    const std::string text = "[a]\r\n" + key + "=1\r\n y=\x01=2\t \r\n\r\n\tz\t=\t3";
    Read read{text};

    const auto entries = read.entries(0);
    ASSERT_EQ(entries.size(), 3U) << length;
    EXPECT_EQ(entries[0].key, key);
    EXPECT_EQ(entries[0].value, "1");
    EXPECT_EQ(entries[1].value, "=2");
    EXPECT_EQ(entries[1].pos(), (SourcePos{3, 5}));
    EXPECT_EQ(entries[2].key, "z");
    EXPECT_EQ(entries[2].pos(), (SourcePos{5, 6}));
  }
}

TEST(Ini, ReportsOfLinesItCannotUse) {
  Read read{"early=1\n[a\nnonsense\n[b] tail\nx=1\n# remark\n"};

  const auto findings = read.report.take();
  EXPECT_EQ(test::find(findings, "entry-outside-section")->pos.line, 1U);
  EXPECT_EQ(test::find(findings, "section-not-closed")->pos.line, 2U);
  EXPECT_EQ(test::find(findings, "no-equals")->pos.line, 3U);
  EXPECT_EQ(test::find(findings, "text-after-section")->pos, (SourcePos{4, 5}));
  EXPECT_EQ(test::find(findings, "hash-comment")->pos.line, 6U);
  ASSERT_EQ(read.file.sections.size(), 2U);
  EXPECT_EQ(read.file.sections[0].name, "a");
  EXPECT_EQ(read.entries(0).size(), 0U);
  EXPECT_EQ(read.entries(1).size(), 1U);
}

TEST(Ini, SaysOnceWhereTheEncodingIsAssumed) {
  const auto assumed = [](std::string_view text) {
    Read read{text};
    Findings declared;
    for (const auto& finding : read.report.take()) {
      if (finding.rule == "encoding-assumed") declared.push_back(finding);
    }
    return declared;
  };

  const auto findings = assumed("[a]\r\nx=\xC3\xA4\r y=\xE2\x82\xAC\xE4\xF6\nz=\xFC\n");
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].pos, (SourcePos{3, 7}));
  EXPECT_EQ(findings[0].severity, Severity::note);
  EXPECT_EQ(findings[0].message,
            "byte 0xE4 is not UTF-8; texts with such bytes were read as Windows-1252");
  EXPECT_EQ(assumed("\xEF\xBB\xBF\xE4").at(0).pos, (SourcePos{1, 1}));
  EXPECT_EQ(assumed("\n\r\nx=\xC3").at(0).pos, (SourcePos{3, 3}));
  EXPECT_TRUE(assumed("[a]\nx=\xC3\xA4\xF0\x9F\x98\x80\n").empty());
  EXPECT_TRUE(assumed(std::string{"\xFF\xFE[\0a\0]\0\n\0x\0=\0\xE4\0", 16}).empty());
}

TEST(Ini, ReadsUtf16AndSkipsTheMark) {
  const std::string little{"\xFF\xFE[\0a\0]\0\n\0x\0=\0\xE4\0", 16};
  const std::string big{"\xFE\xFF\0[\0a\0]\0\n\0x\0=\0\xE4", 16};
  for (const auto& text : {little, big}) {
    Read read{text};
    ASSERT_EQ(read.file.sections.size(), 1U);
    EXPECT_EQ(read.entries(0)[0].value, "\xC3\xA4");
  }
  Read marked{"\xEF\xBB\xBF[a]\nx=1\n"};
  EXPECT_EQ(marked.file.sections[0].pos, (SourcePos{1, 1}));
}

TEST(Ini, AnOpenHeaderEndsBeforeAComment) {
  Read read{"[2000 ;foo\nx=1\n[;\n"};

  ASSERT_EQ(read.file.sections.size(), 2U);
  EXPECT_EQ(read.file.sections[0].name, "2000");
  EXPECT_EQ(read.file.sections[1].name, "");
  EXPECT_EQ(read.entries(0).size(), 1U);
}

}  // namespace
}  // namespace takt
