#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <utility>

#include "eds_parser/write/configured_values.hpp"
#include "eds_parser/write/dcf_writer.hpp"
#include "test/unit/eds_parser/read/device_files.hpp"
#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream stream{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{stream}, {}};
}

/// Returns a legal value for an object: its low limit, else 1. Returns std::nullopt if the object
/// must not be written.
std::optional<std::string> new_value(const SubObject& sub) {
  const bool writable = sub.access != Access::ro && sub.access != Access::constant;
  if (!writable || (sub.flags & 1) != 0) return std::nullopt;
  if (sub.type == DataType::domain || sub.type == DataType::octet_string) return "0A0B";
  if (sub.type == DataType::unknown) return "1";
  if (is_bytes(sub.type)) return "text";
  if (sub.low_limit && std::holds_alternative<std::int64_t>(*sub.low_limit)) {
    return std::to_string(std::get<std::int64_t>(*sub.low_limit));
  }
  if (sub.low_limit && std::holds_alternative<std::uint64_t>(*sub.low_limit)) {
    return std::to_string(std::get<std::uint64_t>(*sub.low_limit));
  }
  if (sub.high_limit) return std::nullopt;
  return "1";
}

std::vector<DcfValue> values_for(const ObjectDictionary& dictionary) {
  std::vector<DcfValue> values;
  for (const auto& object : dictionary.objects) {
    for (const auto& sub : object.subs) {
      const ObjectKey key{object.index, sub.sub};
      if (dictionary.find(key) != &sub) continue;  // another one has this key
      if (auto text = new_value(sub)) values.push_back({key, *std::move(text)});
    }
  }
  return values;
}

void expect_same(const SubObject& before, const SubObject& after, const std::string& where) {
  EXPECT_EQ(before.name, after.name) << where;
  EXPECT_EQ(before.type_code, after.type_code) << where;
  EXPECT_EQ(before.access, after.access) << where;
  EXPECT_EQ(before.pdo_mappable, after.pdo_mappable) << where;
  EXPECT_EQ(before.low_limit, after.low_limit) << where;
  EXPECT_EQ(before.high_limit, after.high_limit) << where;
  EXPECT_EQ(before.default_text, after.default_text) << where;
}

/// Checks the concise DCF of the written file: it must hold each new value of the objects of
/// `before` and must be readable from its bytes. PDOs are rewritten as a whole; 1010 and 1011 are
/// commands.
void expect_concise(const ObjectDictionary& before, const EdsFile& after,
                    const std::string& where) {
  Report report{where};
  const auto entries = configured_values(after.dictionary, report);
  const auto again = decode_concise_dcf(encode_concise_dcf(entries));
  ASSERT_TRUE(again.has_value()) << where;
  EXPECT_TRUE(*again == entries) << where;
  for (const auto& value : values_for(before)) {
    const auto index = value.object.index;
    const bool other = (index >= 0x1400 && index < 0x1C00) || index == 0x1010 || index == 0x1011;
    const auto* sub = after.dictionary.find(value.object);
    if (other || sub == nullptr || sub->type == DataType::unknown) continue;
    const ConciseEntry wanted{value.object, to_bytes(*sub->parameter_value, sub->type)};
    EXPECT_EQ(std::ranges::count(entries, wanted), 1) << where << ' ' << to_string(value.object);
  }
}

/// Writes values to the objects of a file, checks that all read back, and returns their number.
std::size_t round_trip(const std::filesystem::path& path) {
  const auto source = text_of(path);
  const auto before = read_eds(source, "x.eds", 5_node);
  if (!before.readable) return 0;
  const DcfOptions options{.node = 5_node, .values = values_for(before.dictionary)};
  const auto dcf = write_dcf(source, "x.eds", options);
  if (has_error(dcf.findings)) {
    ADD_FAILURE() << path << ": " << to_string(dcf.findings.front());
    return 0;
  }
  const auto after = read_eds(dcf.text, "x.dcf", 5_node);
  EXPECT_EQ(before.dictionary.objects.size(), after.dictionary.objects.size()) << path;
  std::size_t read_back = 0;
  for (const auto& object : before.dictionary.objects) {
    for (const auto& sub : object.subs) {
      const ObjectKey key{object.index, sub.sub};
      const auto* other = after.dictionary.find(key);
      const auto where = path.string() + ' ' + to_string(key);
      EXPECT_NE(other, nullptr) << where;
      if (other == nullptr || before.dictionary.find(key) != &sub) continue;
      expect_same(sub, *other, where);
      const bool set = new_value(sub).has_value();
      EXPECT_TRUE(set ? other->parameter_value.has_value()
                      : other->parameter_value == sub.parameter_value)
          << where;
      read_back += set;
    }
  }
  expect_concise(before.dictionary, after, path.string());
  return read_back;
}

TEST(DcfRoundTrip, EveryWritableObjectOfOwnFilesReadsBack) {
  std::size_t values = 0;
  for (const auto& folder : {test::own_eds_files(), test::nasty_eds_files()}) {
    for (const auto& path : test::device_files(folder)) values += round_trip(path);
  }
  EXPECT_GT(values, 200U);
}

TEST(DcfRoundTrip, EveryWritableObjectOfRealFilesReadsBack) {
  for (const auto& path : test::device_files(test::eds_corpus())) round_trip(path);
}

TEST(DcfRoundTrip, WithoutChangesTheTextStaysToTheByte) {
  for (const auto& folder : {test::own_eds_files(), test::eds_corpus()}) {
    for (const auto& path : test::device_files(folder)) {
      const auto source = text_of(path);
      const auto read = read_eds(source, "x.dcf");
      if (!read.readable || test::has(read.findings, "utf-16")) continue;
      EXPECT_TRUE(write_dcf(source, "x.dcf", {}).text == source) << path;
    }
  }
}

}  // namespace
}  // namespace takt
