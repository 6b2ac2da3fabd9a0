#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>
#include <vector>

#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/print/print_dictionary.hpp"
#include "test/unit/eds_parser/read/device_files.hpp"
#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

namespace fs = std::filesystem;
using test::device_files;

/// Runs a file through the reader, the checks, and the text and JSON outputs. The JSON must be
/// valid.
EdsFile run(const fs::path& path, std::optional<NodeId> node) {
  auto file = read_eds_file(path, node);
  auto judged = check(file.dictionary);
  std::ranges::move(judged, std::back_inserter(file.findings));
  std::ostringstream json;
  std::ostringstream text;
  print_json(json, file.dictionary, file.findings);
  print_text(text, file.dictionary);
  // The JSON of the largest files is not parsed: that takes long and checks nothing else.
  const bool small = json.str().size() < 300'000;
  EXPECT_TRUE(!small || nlohmann::json::accept(json.str())) << path;
  EXPECT_TRUE(std::ranges::is_sorted(file.dictionary.objects, {}, &Object::index)) << path;
  for (const auto& object : file.dictionary.objects) {
    EXPECT_TRUE(std::ranges::is_sorted(object.subs, {}, &SubObject::sub)) << path;
  }
  return file;
}

TEST(Corpus, OwnNastyFilesGoThrough) {
  const auto files = device_files(test::nasty_eds_files());
  EXPECT_GE(files.size(), 8U);
  for (const auto& path : files) {
    run(path, {});
    run(path, 127_node);
  }
}

TEST(Corpus, EveryEncodingGivesTheSameDictionary) {
  for (const auto* name : {"utf16_le.eds", "utf16_be.eds", "no_mark_utf16.eds", "latin1_cr.eds",
                           "utf8_bom_mixed.eds"}) {
    const auto file = run(test::nasty_eds_files() / name, 5_node);
    EXPECT_EQ(test::integer(file, {0x1000, 0}), 0x00020192) << name;
    ASSERT_NE(file.dictionary.find(std::uint16_t{0x1001}), nullptr) << name;
    EXPECT_EQ(file.dictionary.find(std::uint16_t{0x1001})->name,
              "Fehler\xC3\xBC"
              "bersicht")
        << name;
  }
}

TEST(Corpus, ChaosKeepsWhatCanBeRead) {
  const auto file = run(test::nasty_eds_files() / "chaos.eds", 5_node);

  EXPECT_EQ(test::integer(file, {0x1001, 0}), 0);
  EXPECT_EQ(test::integer(file, {0x2000, 0}), 11);
  EXPECT_EQ(test::integer(file, {0x2000, 1}), -2147483647);
  EXPECT_EQ(*file.dictionary.find(ObjectKey{0x2001, 0})->value(), Value{0xFFFFFFFFFFFFFFFFU});
  EXPECT_EQ(*file.dictionary.find(ObjectKey{0x2003, 0})->value(),
            Value{std::string{"\x01\xA1\x05\x3C"}});
  EXPECT_EQ(test::integer(file, {0x2004, 0}), 17);
  EXPECT_EQ(file.dictionary.find(std::uint16_t{0x2007})->subs.size(), 255U);
  EXPECT_EQ(test::integer(file, {0x2007, 254}), 0xBEEF);
  EXPECT_EQ(file.dictionary.find(ObjectKey{0x2007, 1})->name, "one");
  EXPECT_EQ(describe_pdos(file.dictionary).at(0).cob_id(), 0x85U);
  EXPECT_TRUE(test::has(file.findings, "nodeid-not-first"));
}

TEST(Corpus, RealFilesGoThrough) {
  const auto files = device_files(test::eds_corpus() / "files");
  if (files.empty()) GTEST_SKIP() << "no corpus at " << test::eds_corpus();
  std::size_t refused = 0;
  for (const auto& path : files) {
    if (!run(path, 1_node).readable) ++refused;
  }
  EXPECT_LE(refused, 1U);  // one file of the corpus contains only a remark
}

/// The defaults of 1014, 1400:01, 2000, 2001:01 and 2001:02 in a small file, for node 1.
struct Expected {
  const char* file;
  std::optional<std::int64_t> emcy;
  std::optional<std::int64_t> cob_id;
  std::optional<std::int64_t> single;
  std::optional<std::int64_t> first;  ///< first of two elements, both UNSIGNED16
  std::optional<std::int64_t> second;
  const char* rule;  ///< a required finding; nullptr means no requirement
};

constexpr std::nullopt_t none = std::nullopt;

// The result of a careful reader for each file; see the list of cases in the corpus.
const Expected expected[] = {
    {"000.eds", 129, 513, 5, 11, 12, nullptr},
    {"001.eds", 129, 513, 5, 11, 12, "nodeid-not-first"},
    {"002.eds", 129, 513, 5, 11, 12, nullptr},
    {"003.eds", 129, 513, 5, 11, 12, nullptr},
    {"004.eds", 1, 513, 5, 11, 12, nullptr},
    {"005.eds", 129, 513, 5, 11, 12, nullptr},
    {"006.eds", 385, 513, 5, 11, 12, nullptr},
    {"007.eds", 129, 513, 5, 11, 12, nullptr},
    {"008.eds", none, 513, 5, 11, 12, "value-unreadable"},
    {"009.eds", 129, 513, 5, 11, 12, "nodeid-without-dollar"},
    {"010.eds", 129, 513, 10, 11, 12, "octal-number"},
    {"011.eds", 129, 513, 8, 11, 12, "leading-zero"},
    {"012.eds", 129, 513, 31, 11, 12, "hex-without-prefix"},
    {"013.eds", 129, 513, 31, 11, 12, nullptr},
    {"014.eds", 129, 513, -2147483647, 11, 12, nullptr},
    {"015.eds", 129, 513, -16, 11, 12, nullptr},
    {"016.eds", 129, 513, 5, 65535, 12, "negative-unsigned"},
    {"017.eds", 129, 513, 5, none, 12, "value-exceeds-type"},
    {"018.eds", 129, 513, 5, none, 12, "value-unreadable"},
    {"019.eds", 129, 513, 5, none, 12, "value-unreadable"},
    {"020.eds", 129, 513, 5, none, 12, nullptr},
    {"021.eds", 129, 513, 5, 16, 12, "number-suffix"},
    {"022.eds", 129, 513, 5, 11, 12, "blank-in-key"},
    {"023.eds", 129, 513, 5, 11, 12, "list-count-wrong"},
    {"024.eds", 129, 513, 5, 11, 12, "list-count-wrong"},
    {"025.eds", 129, 513, 5, 11, 12, "list-numbers-gap"},
    {"026.eds", 129, 513, 5, 11, 12, "hex-without-prefix"},
    {"027.eds", 129, 513, 5, 11, 12, nullptr},
    {"028.eds", 129, 513, 5, 11, 12, "listed-without-section"},
    {"029.eds", 129, 513, 5, 11, 12, "object-not-listed"},
    {"030.eds", 129, 513, 5, 11, 12, "listed-twice"},
    {"031.eds", 129, 513, 5, 11, 12, "object-not-listed"},
    {"032.eds", 129, 513, 5, 11, 12, "sub-number-wrong"},
    {"033.eds", 129, 513, 5, 11, 12, "sub-number-missing"},
    {"034.eds", 129, 513, 5, 11, 12, "sub-number-wrong"},
    {"035.eds", 129, 513, 5, 11, none, nullptr},
    {"036.eds", 129, 513, 5, 11, 12, nullptr},
    {"037.eds", 129, 513, 5, 11, 12, nullptr},
    {"038.eds", 129, 513, 5, 11, 12, nullptr},
    {"039.eds", 129, 513, 5, 11, 12, nullptr},
    {"040.eds", 129, 513, 5, 11, 12, "object-section-missing"},
    {"041.eds", 129, 513, 5, 11, 12, nullptr},
    {"042.eds", 129, 513, 5, 11, 12, "sub-objects-of-var"},
    {"043.eds", 129, 513, 5, 11, 12, "sub-objects-of-var"},
    {"044.eds", 129, 513, 5, 11, 12, nullptr},
    {"045.eds", 129, 513, 5, 11, 12, nullptr},
    {"046.eds", 129, 513, 5, 11, 12, "duplicate-key"},
    {"047.eds", 129, 513, 5, 11, 12, "duplicate-section"},
    {"048.eds", 129, 513, 5, 11, 12, nullptr},
    {"049.eds", 129, 513, 5, 11, 12, "access-type-missing"},
    {"050.eds", 129, 513, 5, 11, 12, "access-type-missing"},
    {"051.eds", 129, 513, 5, 11, 12, nullptr},
    {"052.eds", 129, 513, 5, 11, 12, "data-type-missing"},
    {"053.eds", 129, 513, 5, 11, 12, "data-type-unknown"},
    {"054.eds", 129, 513, 5, 11, 12, "parameter-name-missing"},
    {"055.eds", 129, 513, 5, 11, 12, nullptr},
    {"056.eds", 129, 513, 5, 11, 12, nullptr},
    {"057.eds", 129, 513, 5, 11, 12, "inline-comment"},
    {"058.eds", 129, 513, 5, 11, 12, "no-equals"},
    {"059.eds", 129, 513, 5, 11, 12, nullptr},
    {"060.eds", 129, 513, 5, 11, 12, nullptr},
    {"061.eds", 129, 513, 5, 11, 12, nullptr},
    {"062.eds", 129, 513, 5, 11, 12, nullptr},
    {"063.eds", 129, 513, 5, 11, 12, "section-name-form"},
    {"064.eds", 129, 513, 5, 11, 12, nullptr},
    {"065.eds", 129, 513, 5, 11, 12, nullptr},
    {"066.eds", 129, 513, 5, 11, 12, nullptr},
    {"067.eds", 129, 513, 5, 11, 12, nullptr},
    {"068.eds", 129, 513, 5, 11, 12, nullptr},
    {"069.eds", 129, 513, 5, 11, 12, nullptr},
    {"070.eds", 129, 513, 5, 11, 12, nullptr},
    {"071.eds", 129, 513, 5, 11, 12, nullptr},
    {"072.eds", 129, 513, 5, 11, 12, nullptr},
    {"073.eds", 129, 513, 5, 11, 12, "long-line"},
    {"074.eds", 129, 513, 5, 11, 12, nullptr},
    {"075.eds", 129, 513, 5, 11, 12, nullptr},
    {"076.eds", 129, 513, 5, 11, 12, nullptr},
    {"077.eds", 129, 513, 5, 11, 12, nullptr},
    {"078.eds", 129, 513, 5, 11, 12, nullptr},
    {"079.eds", 129, 513, 5, 11, 12, nullptr},
    {"080.eds", 129, 513, 5, 11, 12, nullptr},
    {"081.eds", 129, 513, 5, 11, 12, nullptr},
    {"082.eds", 129, 513, 5, 11, 12, nullptr},
    {"083.eds", 129, 513, 5, 7, 7, nullptr},
    {"084.eds", 129, 513, 5, 7, 7, nullptr},
    {"085.eds", 129, 513, 5, 7, 7, nullptr},
    {"086.eds", 129, 513, 5, 7, 7, "compact-and-sub-number"},
    {"087.eds", 129, 513, 5, 7, 12, "compact-and-sections"},
    {"088.eds", 129, 513, 5, none, none, "compact-without-type"},
    {"089.dcf", none, none, 5, 7, 33, nullptr},
    {"090.dcf", none, none, 9, 11, 12, nullptr},
    {"091.dcf", none, none, 5, 11, 12, nullptr},
    {"092.dcf", 150, 518, 5, 11, 12, nullptr},
    {"093.dcf", 134, 518, 5, 11, 12, "section-spelling"},
    {"094.eds", 129, 513, 5, 11, 12, nullptr},
    {"095.eds", 129, 513, 5, 11, 12, nullptr},
    {"096.eds", 129, 513, 5, 11, 12, "limits-inverted"},
    {"097.eds", 129, 513, 5, 11, 12, "default-outside-limits"},
};

/// The expected value of a case that is about another object than those in the other files.
struct ExpectedElsewhere {
  const char* file;
  ObjectKey key;
  std::int64_t value;
};

const ExpectedElsewhere elsewhere[] = {
    {"035.eds", {0x2001, 4}, 12},         {"083.eds", {0x2001, 0}, 3},
    {"083.eds", {0x2001, 3}, 7},          {"084.eds", {0x2001, 0}, 3},
    {"084.eds", {0x2001, 3}, 7},          {"085.eds", {0x2001, 0}, 3},
    {"085.eds", {0x2001, 3}, 7},          {"086.eds", {0x2001, 0}, 3},
    {"086.eds", {0x2001, 3}, 7},          {"087.eds", {0x2001, 3}, 7},
    {"089.dcf", {0x2001, 3}, 7},          {"094.eds", {0x1403, 1}, 0x501},
    {"094.eds", {0x1404, 1}, 0x80000000},
};

TEST(Corpus, SmallCasesComeOutAsExpected) {
  const auto folder = test::eds_corpus() / "mini";
  if (!fs::exists(folder)) GTEST_SKIP() << "no corpus at " << test::eds_corpus();
  for (const auto& wanted : expected) {
    const bool is_dcf = std::string_view{wanted.file}.ends_with(".dcf");
    const auto file = run(folder / wanted.file, is_dcf ? std::optional<NodeId>{} : 1_node);
    EXPECT_TRUE(file.readable) << wanted.file;
    EXPECT_EQ(test::integer(file, {0x1014, 0}), wanted.emcy) << wanted.file;
    EXPECT_EQ(test::integer(file, {0x1400, 1}), wanted.cob_id) << wanted.file;
    EXPECT_EQ(test::integer(file, {0x2000, 0}), wanted.single) << wanted.file;
    EXPECT_EQ(test::integer(file, {0x2001, 1}), wanted.first) << wanted.file;
    EXPECT_EQ(test::integer(file, {0x2001, 2}), wanted.second) << wanted.file;
    if (wanted.rule != nullptr) {
      EXPECT_TRUE(test::has(file.findings, wanted.rule)) << wanted.file << ' ' << wanted.rule;
    }
  }
  for (const auto& wanted : elsewhere) {
    const bool is_dcf = std::string_view{wanted.file}.ends_with(".dcf");
    const auto file = run(folder / wanted.file, is_dcf ? std::optional<NodeId>{} : 1_node);
    EXPECT_EQ(test::integer(file, wanted.key), wanted.value)
        << wanted.file << ' ' << to_string(wanted.key);
  }
}

}  // namespace
}  // namespace takt
