#include "eds_parser/dictionary/pdo_description.hpp"

#include <gtest/gtest.h>

#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

std::string sub(std::string_view section, std::string_view type, std::string_view value) {
  return "[" + std::string{section} +
         "]\nParameterName=x\nAccessType=rw\nDataType=" + std::string{type} +
         "\nDefaultValue=" + std::string{value} + "\n";
}

std::string tpdo(std::string_view cob_id, std::string_view count) {
  return sub("1800sub0", "5", "6") + sub("1800sub1", "7", cob_id) + sub("1800sub2", "5", "3") +
         sub("1800sub3", "6", "25") + sub("1800sub5", "6", "100") + sub("1800sub6", "5", "2") +
         sub("1A00sub0", "5", count) + sub("1A00sub1", "7", "0x60410010") +
         sub("1A00sub2", "7", "0x60640020") + sub("1A00sub3", "7", "0x20000308") +
         "[6041]\nParameterName=Statusword\nDataType=6\nAccessType=ro\nPDOMapping=1\n";
}

PdoDescription first(const std::string& text, std::optional<NodeId> node = 5_node) {
  return describe_pdos(test::read(text, node).dictionary).at(0);
}

TEST(PdoDescription, SaysWhatTheRecordsSay) {
  const auto pdo = first(tpdo("$NODEID+0x40000180", "2"));

  EXPECT_TRUE(pdo.is_tpdo);
  EXPECT_EQ(pdo.number, 1);
  EXPECT_EQ(pdo.cob_id(), 0x185U);
  EXPECT_EQ(pdo.cob_id_raw, 0x40000185U);
  EXPECT_TRUE(pdo.valid);
  EXPECT_FALSE(pdo.rtr_allowed);
  EXPECT_FALSE(pdo.extended);
  EXPECT_EQ(pdo.transmission_type, 3);
  EXPECT_EQ(pdo.inhibit_time_us, 2500U);
  EXPECT_EQ(pdo.event_timer_ms, 100);
  EXPECT_EQ(pdo.sync_start, 2);
  EXPECT_EQ(pdo.bits, 48U);
  ASSERT_EQ(pdo.mapping.size(), 2U);
  EXPECT_EQ(pdo.mapping[0].name, "Statusword");
  EXPECT_EQ(pdo.mapping[1].key, (ObjectKey{0x6064, 0}));
  EXPECT_EQ(pdo.mapping[1].bit_offset, 16);
  EXPECT_EQ(pdo.mapping[1].name, "");
}

TEST(PdoDescription, ReadsTheFlagsOfACobId) {
  EXPECT_FALSE(first(tpdo("0x80000185", "2")).valid);
  EXPECT_FALSE(first(tpdo("0xC0000000", "2")).rtr_allowed);
  const auto extended = first(tpdo("0x20012345", "2"));
  EXPECT_TRUE(extended.valid);
  EXPECT_TRUE(extended.extended);
  EXPECT_EQ(extended.cob_id(), 0x12345U);
}

TEST(PdoDescription, KnowsTheFlagsWithoutANodeId) {
  const auto off = first(tpdo("$NODEID+0x80000180", "2"), std::nullopt);
  const auto on = first(tpdo("$NODEID+0x180", "2"), std::nullopt);

  EXPECT_EQ(off.cob_id(), std::nullopt);
  EXPECT_FALSE(off.valid);
  EXPECT_TRUE(on.valid);
}

TEST(PdoDescription, ReportsWhatIsAddedToAnUnknownNodeId) {
  const auto pdo = first(tpdo("$NODEID+0x40000180", "2"), std::nullopt);

  EXPECT_EQ(pdo.cob_id(), std::nullopt);
  EXPECT_EQ(pdo.cob_id_offset, 0x180U);
  EXPECT_EQ(first(tpdo("$NODEID+0x40000180", "2")).cob_id_offset, std::nullopt);
}

TEST(PdoDescription, LetsSub0DecideHowManyEntriesAreActive) {
  EXPECT_EQ(first(tpdo("0x181", "0")).mapping.size(), 0U);
  EXPECT_EQ(first(tpdo("0x181", "1")).bits, 16U);
  EXPECT_EQ(first(tpdo("0x181", "3")).bits, 56U);
  EXPECT_EQ(first(tpdo("0x181", "0xFE")).mapping.size(), 0U);
  EXPECT_EQ(first(tpdo("0x181", "")).mapping.size(), 3U);  // no count: all are described
}

TEST(PdoDescription, NeedsACommunicationRecord) {
  EXPECT_TRUE(describe_pdos(test::read(sub("1A04sub0", "5", "0")).dictionary).empty());
}

TEST(MappableRecord, IsThatOfEitherDirectionWhoseCountIsWritable) {
  for (const std::uint16_t index : {std::uint16_t{0x1600}, std::uint16_t{0x1A00}}) {
    ObjectDictionary dictionary;
    Object& record = dictionary.objects.emplace_back();
    record.index = index;
    record.subs.emplace_back().access = Access::ro;
    EXPECT_EQ(mappable_record(dictionary), nullptr);
    record.subs[0].access = Access::rw;
    EXPECT_EQ(mappable_record(dictionary), &record);
    record.index = 0x1800;
    EXPECT_EQ(mappable_record(dictionary), nullptr);
  }
}

}  // namespace
}  // namespace takt
