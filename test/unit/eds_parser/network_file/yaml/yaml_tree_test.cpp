#include "eds_parser/network_file/yaml/yaml_tree.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

struct Parsed {
  YamlTree tree;
  Findings findings;
};

Parsed parse(std::string_view text) {
  Parsed out;
  out.tree = YamlTree::parse(text, "f", out.findings);
  return out;
}

std::string first(const Parsed& parsed) {
  return parsed.findings.empty() ? "" : to_string(parsed.findings[0]);
}

TEST(YamlTree, KeepsLineAndColumnOfKeysAndValues) {
  const auto parsed = parse("a: 1\nb:\n  c: [x, y]\n");

  const YamlNode* c = parsed.tree.root()->find("b")->find("c");

  EXPECT_EQ(c->items[1]->pos, (SourcePos{3, 10}));
  EXPECT_EQ(parsed.tree.root()->pairs[1].key_pos, (SourcePos{2, 1}));
}

TEST(YamlTree, AnEmptyFileIsReportedAtItsBeginning) {
  for (const auto* text : {"", "# nothing\n"}) {
    const auto parsed = parse(text);
    ASSERT_EQ(parsed.findings.size(), 1U);
    EXPECT_EQ(parsed.findings[0].rule, "syntax");
    EXPECT_EQ(parsed.findings[0].pos, (SourcePos{1, 1}));
  }
}

TEST(YamlTree, MergeKeysLoseAgainstOwnKeysAndEarlierMaps) {
  const auto parsed = parse(
      "a: &a {x: 1, y: 1}\n"
      "b: &b {x: 2, z: 2}\n"
      "c: {<<: [*a, *b], y: 3}\n");

  const YamlNode* c = parsed.tree.root()->find("c");

  EXPECT_EQ(c->find("y")->text, "3");
  EXPECT_EQ(c->find("x")->text, "1");
  EXPECT_EQ(c->find("z")->text, "2");
  EXPECT_TRUE(parsed.findings.empty());
}

TEST(YamlTree, ReportsAKeyThatIsWrittenTwice) {
  const auto parsed = parse("a: 1\nb: 2\na: 3\n");

  EXPECT_EQ(first(parsed),
            "f:3:1: error: key `a` is written twice, first in line 1: keep one [duplicate-key]");
}

TEST(YamlTree, ManyMergesOfALargeMapAreRefused) {
  const auto merged = [](int times) {
    std::string text = "a: &a {";
    for (int i = 0; i < 999; ++i) text += "k" + std::to_string(i) + ": 1, ";
    text += "last: 1}\n";
    for (int i = 0; i < times; ++i) text += "m" + std::to_string(i) + ": {<<: *a}\n";
    return parse(text);
  };
  EXPECT_TRUE(merged(99).findings.empty());
  ASSERT_FALSE(merged(100).findings.empty());
  EXPECT_EQ(merged(100).findings[0].rule, "too-large");
}

TEST(YamlTree, BillionLaughsStaySmall) {
  std::string text = "a0: &a0 [lol, lol, lol, lol, lol, lol, lol, lol, lol]\n";
  for (int i = 1; i < 30; ++i) {
    const std::string p = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + p;
    for (int k = 0; k < 8; ++k) text += ", " + p;
    text += "]\n";
  }

  const auto parsed = parse(text);

  ASSERT_NE(parsed.tree.root(), nullptr);
  EXPECT_EQ(parsed.tree.root()->find("a29")->items.size(), 9U);
}

TEST(YamlTree, MergeBombsAreCutShort) {
  std::string text = "m0: &m0 {";
  for (int i = 0; i < 1000; ++i) text += (i ? ", k" : "k") + std::to_string(i) + ": 1";
  text += "}\n";
  for (int i = 1; i < 2000; ++i) {
    text += "m" + std::to_string(i) + ": {<<: [*m0, *m0, *m0]}\n";
  }

  const auto parsed = parse(text);

  EXPECT_EQ(parsed.tree.root(), nullptr);
  EXPECT_NE(first(parsed).find("merge keys expand to more than 100000 entries"), std::string::npos);
}

TEST(YamlTree, AnAliasInsideItsOwnValueIsAnError) {
  const auto parsed = parse("a: &a\n  b: *a\n");

  EXPECT_EQ(first(parsed),
            "f:2:6: error: this alias refers to a value that contains the alias itself [alias]");
}

TEST(YamlTree, DeepNestingIsRefused) {
  EXPECT_NE(first(parse(std::string(40, '['))).find("nested more than 32 levels deep"),
            std::string::npos);
  EXPECT_NE(first(parse(std::string(100'000, '['))).find("[too-deep]"), std::string::npos);
}

TEST(YamlTree, SyntaxErrorsNameTheirLine) {
  EXPECT_EQ(first(parse("a: 1\nb: [1, 2\n")).substr(0, 4), "f:3:");
  EXPECT_NE(first(parse("a: 1\n\tb: 2\n")).find("[syntax]"), std::string::npos);
}

TEST(YamlTree, ASecondDocumentIsAnError) {
  EXPECT_NE(first(parse("a: 1\n---\nb: 2\n")).find("a file describes one network"),
            std::string::npos);
}

TEST(YamlTree, AnEmptyFileSaysWhatBelongsIntoIt) {
  EXPECT_NE(first(parse("")).find("`master:` and `nodes:`"), std::string::npos);
}

TEST(YamlTree, AMegabyteOfTextIsNoNetworkFile) {
  EXPECT_NE(first(parse(std::string((1 << 20) + 1, 'a'))).find("[too-large]"), std::string::npos);
}

}  // namespace
}  // namespace takt
