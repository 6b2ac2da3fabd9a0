#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/command_line/failure.hpp"
#include "apps/takt/od/od_entry.hpp"
#include "apps/takt/od/od_reader.hpp"
#include "apps/takt/od/od_text.hpp"

namespace takt {
namespace {

using testing::HasSubstr;

class OdOfADrive : public testing::Test {
 protected:
  static const OdEntry& at(const std::vector<OdEntry>& entries, ObjectKey key) {
    const auto found = std::ranges::find(entries, key, &OdEntry::key);
    EXPECT_NE(found, entries.end());
    return *found;
  }

  KnownDevice device = device_of_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml", "shoulder");
};

TEST_F(OdOfADrive, ARangeAndAWordChoose) {
  OdChoice choice;
  ASSERT_TRUE(read_range("6040..0x6041", choice));
  EXPECT_EQ(od_entries(device, choice).size(), 2U);
  EXPECT_FALSE(read_range("6041..6040", choice));
  EXPECT_FALSE(read_range("x..6040", choice));
  EXPECT_FALSE(read_range("10000", choice));

  EXPECT_EQ(od_entries(device, {.word = "Vendor-ID"}).size(), 1U);
  EXPECT_EQ(od_entries(device, {.word = "607a"}).size(), 1U);
  EXPECT_TRUE(od_entries(device, {.word = "zzz"}).empty());
}

TEST_F(OdOfADrive, EntriesKnowTheirPdos) {
  const std::vector<OdEntry> entries = od_entries(device, {});

  EXPECT_THAT(at(entries, {0x6041, 0}).pdos, testing::ElementsAre("TPDO1"));
  EXPECT_THAT(at(entries, {0x607A, 0}).pdos, testing::ElementsAre("RPDO1"));
  EXPECT_TRUE(at(entries, {0x1000, 0}).pdos.empty());
}

TEST_F(OdOfADrive, EachLineFits80Columns) {
  std::vector<OdEntry> entries = od_entries(device, {});
  take_file_values(entries);
  OdTable table{device, 80};
  std::string text = table.heading();
  for (const OdEntry& entry : entries) text += table.row(entry);

  std::istringstream lines{text};
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 80U) << line;
    EXPECT_FALSE(line.ends_with(' ')) << line;
  }
  EXPECT_THAT(text, HasSubstr("\n6041:00  statusword                  u16    ro    T1"));
  EXPECT_THAT(text, HasSubstr("0x00020192  CiA 402"));
}

TEST_F(OdOfADrive, NothingIsReadThatHasAnEffect) {
  const auto object = [](std::uint16_t index, Access access, DataType type) {
    Object made;
    made.index = index;
    made.name = "Object " + std::to_string(index);
    SubObject& sub = made.subs.emplace_back();
    sub.access = access;
    sub.type = type;
    return made;
  };
  Object shy = object(0x2001, Access::ro, DataType::unsigned8);
  shy.subs[0].flags = 2;
  ObjectDictionary dictionary;
  dictionary.objects = {object(0x1023, Access::ro, DataType::octet_string),
                        object(0x1F50, Access::rw, DataType::domain),
                        object(0x2000, Access::wo, DataType::unsigned8), shy};
  const KnownDevice made{.file = "made.eds", .dictionary = dictionary};
  int reads = 0;
  OdReader reader{[&](ObjectKey) {
    ++reads;
    return std::vector<std::byte>{};
  }};

  for (OdEntry& entry : od_entries(made, {})) {
    reader.read(entry);
    EXPECT_FALSE(entry.value);
    EXPECT_FALSE(entry_text(made, entry).empty()) << entry.name;
  }

  EXPECT_EQ(reads, 0);
}

TEST_F(OdOfADrive, ARefusalIsShownAndADeviceThatFallsSilentIsLeftAlone) {
  std::vector<OdEntry> entries = od_entries(device, {});
  int reads = 0;
  OdReader reader{[&](ObjectKey) -> std::vector<std::byte> {
    if (++reads == 1) throw Failure{"refused", 1, 0x0602'0000};
    throw Failure{"the device did not answer in time", 1, 0x0504'0000};
  }};

  for (OdEntry& entry : entries) reader.read(entry);

  EXPECT_EQ(entries[0].error, "object does not exist in the dictionary");
  EXPECT_TRUE(reader.silent());
  EXPECT_EQ(reads, 4);
}

TEST_F(OdOfADrive, ABusThatIsGoneEndsIt) {
  std::vector<OdEntry> entries = od_entries(device, {});
  OdReader reader{[](ObjectKey) -> std::vector<std::byte> { throw Failure{"bus is gone", 3}; }};

  EXPECT_THROW(reader.read(entries[0]), Failure);
}

TEST_F(OdOfADrive, JsonHasNumbersUnitsAndReasons) {
  std::vector<OdEntry> entries = od_entries(device, {.first = 0x6081, .last = 0x6081, .word = {}});
  ASSERT_FALSE(entries.empty());
  entries[0].value = std::vector<std::byte>{std::byte{0x88}, std::byte{0x13}, {}, {}};

  const auto json = nlohmann::json::parse(od_json(device, entries, true));

  EXPECT_EQ(json["node"], "shoulder");
  EXPECT_EQ(json["node_id"], 1);
  EXPECT_EQ(json["live"], true);
  const auto& object = json["objects"][0];
  EXPECT_EQ(object["index"], 0x6081);
  EXPECT_EQ(object["value"], 5000);
  EXPECT_EQ(object["unit"], "rad/s");
  EXPECT_NEAR(object["si"].get<double>(), 3.14159, 1e-4);
  EXPECT_EQ(object["type"], "UNSIGNED32");
}

}  // namespace
}  // namespace takt
