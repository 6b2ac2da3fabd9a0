#include "eds_parser/check/check.hpp"

#include <gtest/gtest.h>

#include "test/unit/eds_parser/read/eds_text.hpp"

namespace takt {
namespace {

using test::find;
using test::has;
using test::line_of;
using test::read;

std::string entry(std::string_view section, std::string_view type, std::string_view value,
                  std::string_view access = "rw", bool mappable = false) {
  return "[" + std::string{section} + "]\nParameterName=x\nDataType=" + std::string{type} +
         "\nAccessType=" + std::string{access} + "\nPDOMapping=" + (mappable ? "1" : "0") +
         "\nDefaultValue=" + std::string{value} + "\n";
}

constexpr std::uint32_t entry_lines = 6;

/// Makes TPDO1 or RPDO1 with a mapping of `first`, and the objects of a drive.
std::string pdo(bool is_tpdo, std::string_view cob_id, std::string_view type,
                std::string_view first) {
  const std::string communication = is_tpdo ? "1800" : "1400";
  const std::string mapping = is_tpdo ? "1A00" : "1600";
  return entry(mapping + "sub1", "7", first) + entry(mapping + "sub0", "5", "1") +
         entry(communication + "sub0", "5", "2") + entry(communication + "sub1", "7", cob_id) +
         entry(communication + "sub2", "5", type) + entry("6040", "6", "0", "rww", true) +
         entry("6041", "6", "0", "ro", true) + entry("6064", "4", "0", "ro", false) +
         entry("60FD", "7", "0", "wo", true);
}

Findings tpdo(std::string_view first, std::string_view cob_id = "$NODEID+0x180",
              std::string_view type = "1") {
  return check(read(pdo(true, cob_id, type, first)).dictionary);
}

Findings rpdo(std::string_view first, std::string_view cob_id = "$NODEID+0x200",
              std::string_view type = "1") {
  return check(read(pdo(false, cob_id, type, first)).dictionary);
}

TEST(Check, SaysNothingOfAGoodDevice) {
  EXPECT_TRUE(check(read("").dictionary).empty());
  EXPECT_FALSE(has_error(tpdo("0x60410010")));
  EXPECT_FALSE(has_error(rpdo("0x60400010")));
}

TEST(Check, NamesTheMappingEntryThatADeviceWouldRefuse) {
  const auto findings = tpdo("0x60640020");

  const auto* finding = find(findings, "pdo-not-mappable");
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->severity, Severity::error);
  EXPECT_EQ(finding->pos, (SourcePos{line_of(entry_lines), 14}));
  EXPECT_EQ(to_string(*finding), "t.eds:" + std::to_string(line_of(entry_lines)) +
                                     ":14: error: 1A00sub1: object 6064:00 is not PDO-mappable "
                                     "(PDOMapping=0) [pdo-not-mappable]");
}

TEST(Check, RefusesAMappingWhoseEntriesBeginNobodyKnowsWhere) {
  const std::string device = entry("1A00sub3", "7", "0x60640020") + entry("1A00sub2", "7", "") +
                             entry("1A00sub1", "7", "0x60410010") + entry("1800sub1", "7", "0x181");
  const auto gap = check(read(device + entry("1A00sub0", "5", "3")).dictionary);

  ASSERT_TRUE(has(gap, "pdo-mapping-gap"));
  EXPECT_EQ(find(gap, "pdo-mapping-gap")->pos, (SourcePos{line_of(6), 14}));
  EXPECT_FALSE(
      has(check(read(device + entry("1A00sub0", "5", "2")).dictionary), "pdo-mapping-gap"));
}

TEST(Check, JudgesMappingEntries) {
  EXPECT_TRUE(has(tpdo("0x60990010"), "pdo-object-missing"));
  EXPECT_TRUE(has(tpdo("0x60410110"), "pdo-object-missing"));
  EXPECT_TRUE(has(tpdo("0x60410020"), "pdo-entry-length"));
  EXPECT_TRUE(has(tpdo("0x60FD0020"), "pdo-direction"));
  EXPECT_TRUE(has(rpdo("0x60410010"), "pdo-direction"));
  EXPECT_TRUE(has(tpdo("0x60400010"), "pdo-direction-hint"));
  EXPECT_FALSE(has(rpdo("0x00050008"), "pdo-dummy"));  // allowed by [DummyUsage]
  EXPECT_TRUE(has(rpdo("0x00060010"), "pdo-dummy"));
  EXPECT_TRUE(has(rpdo("0x00050010"), "pdo-entry-length"));
  EXPECT_TRUE(has(tpdo("0x00050008"), "pdo-dummy"));
}

TEST(Check, CountsTheBitsOfAPdo) {
  const auto file =
      read(pdo(true, "$NODEID+0x180", "1", "0x60410010") + entry("1A01sub0", "5", "3") +
           entry("1A01sub1", "7", "0x60640020") + entry("1A01sub2", "7", "0x60FD0020") +
           entry("1A01sub3", "7", "0x60410010") + entry("1801sub0", "5", "1") +
           entry("1801sub1", "7", "$NODEID+0x280"));
  const auto findings = check(file.dictionary);

  ASSERT_TRUE(has(findings, "pdo-too-long"));
  EXPECT_EQ(find(findings, "pdo-too-long")->message,
            "TPDO2: the mapped objects need 80 bits, a PDO has 64");
  EXPECT_TRUE(has(findings, "pdo-count"));
}

TEST(Check, KnowsTheTransmissionTypesOfEachDirection) {
  EXPECT_FALSE(has(tpdo("0x60410010", "$NODEID+0x180", "240"), "pdo-transmission-type"));
  EXPECT_TRUE(has(tpdo("0x60410010", "$NODEID+0x180", "241"), "pdo-transmission-type"));
  EXPECT_FALSE(has(tpdo("0x60410010", "$NODEID+0x180", "253"), "pdo-transmission-type"));
  EXPECT_TRUE(has(rpdo("0x60400010", "$NODEID+0x200", "253"), "pdo-transmission-type"));
  EXPECT_FALSE(has(rpdo("0x60400010", "$NODEID+0x200", "254"), "pdo-transmission-type"));
}

TEST(Check, KnowsTheRestrictedCobIds) {
  const auto restricted = [](std::string_view cob_id) {
    return has(tpdo("0x60410010", cob_id), "cob-id-restricted");
  };

  // CiA 301, 7.3.5, table 40
  EXPECT_TRUE(restricted("0x000"));
  EXPECT_TRUE(restricted("0x07F"));
  EXPECT_TRUE(restricted("0x101"));
  EXPECT_TRUE(restricted("0x180"));
  EXPECT_FALSE(restricted("0x181"));
  EXPECT_FALSE(restricted("0x580"));
  EXPECT_TRUE(restricted("0x581"));
  EXPECT_TRUE(restricted("0x67F"));
  EXPECT_FALSE(restricted("0x680"));
  EXPECT_TRUE(restricted("0x6E0"));
  EXPECT_FALSE(restricted("0x700"));
  EXPECT_TRUE(restricted("0x7E5"));
  EXPECT_FALSE(restricted("0x80000000"));  // off
  EXPECT_FALSE(restricted("0x20000000"));  // 29 bits
  EXPECT_TRUE(restricted("$NODEID+0x580"));
}

TEST(Check, ReportsAnExtendedFrameWhoseIdFits11Bits) {
  const auto reported = [](std::string_view cob_id) {
    const auto findings = tpdo("0x60410010", cob_id);
    const auto* found = find(findings, "cob-id-extended");
    return found == nullptr ? "" : std::string{name(found->severity)} + ": " + found->message;
  };

  EXPECT_EQ(
      reported("$NODEID+0x20000180"),
      "warning: 1800sub1: COB-ID $NODEID+0x20000180 has bit 29 set: this is the 29-bit "
      "identifier $NODEID+0x00000180, although 11 bits are enough; clear bit 29 for a base frame");
  EXPECT_NE(reported("0x60000185"), "");
  EXPECT_NE(reported("0x200007FF"), "");
  EXPECT_EQ(reported("0x20000800"), "");
  EXPECT_EQ(reported("0x38000185"), "");
  EXPECT_EQ(reported("$NODEID+0x180"), "");
  EXPECT_EQ(reported("0xA0000185"), "");  // off
}

TEST(Check, AbsoluteCobIdsOf29BitsAreReportedToo) {
  const auto findings = tpdo("0x60410010", "0x38000185");
  ASSERT_TRUE(has(findings, "cob-id-absolute"));
  EXPECT_TRUE(find(findings, "cob-id-absolute")->message.contains("COB-ID 0x18000185 is the same"));
  EXPECT_FALSE(has(tpdo("0x60410010", "$NODEID+0x38000180"), "cob-id-absolute"));
}

TEST(Check, BitsOfSyncTimeAndEmcyAreLookedAtToo) {
  const auto rules = [](std::string_view index, std::string_view cob_id) {
    const auto text = '[' + std::string{index} + "]\nParameterName=x\nDataType=7\nAccessType=rw\n" +
                      "DefaultValue=" + std::string{cob_id} + "\n";
    const auto findings = check(read(text).dictionary);
    return std::pair{has(findings, "cob-id-extended"), has(findings, "cob-id-bits")};
  };

  for (const auto* index : {"1005", "1012", "1014"}) {
    EXPECT_EQ(rules(index, "0x200000F0"), (std::pair{true, false})) << index;
    EXPECT_EQ(rules(index, "0x000100F0"), (std::pair{false, true})) << index;
    EXPECT_EQ(rules(index, "0x200100F0"), (std::pair{false, false})) << index;
    EXPECT_EQ(rules(index, "0xF0"), (std::pair{false, false})) << index;
  }
  EXPECT_EQ(rules("1005", "0xC0000080"),
            (std::pair{false, false}));  // produces SYNC; bit 31 has no meaning
  EXPECT_EQ(rules("1012", "0xC0000100"), (std::pair{false, false}));  // consumes and produces TIME
  EXPECT_EQ(rules("1014", "$NODEID+0x40000080"), (std::pair{false, true}));
  EXPECT_EQ(rules("1014", "$NODEID+0xC0000080"), (std::pair{false, false}));  // off
}

TEST(Check, Bit30IsReportedOfRpdosOnly) {
  const auto findings = rpdo("0x60400010", "$NODEID+0x40000200");
  ASSERT_TRUE(has(findings, "pdo-rtr-of-rpdo"));
  EXPECT_EQ(find(findings, "pdo-rtr-of-rpdo")->severity, Severity::note);
  EXPECT_EQ(find(findings, "pdo-rtr-of-rpdo")->message,
            "1400sub1: COB-ID $NODEID+0x40000200 has bit 30 set (no remote requests), which has no "
            "meaning for an RPDO");
  EXPECT_FALSE(has(rpdo("0x60400010", "$NODEID+0x200"), "pdo-rtr-of-rpdo"));
  EXPECT_FALSE(has(rpdo("0x60400010", "$NODEID+0xC0000200"), "pdo-rtr-of-rpdo"));  // off
  EXPECT_FALSE(has(tpdo("0x60410010", "$NODEID+0x40000180"), "pdo-rtr-of-rpdo"));
}

TEST(Check, LooksAtEachNodeWhereTheNodeIdIsUnknown) {
  const auto finding = [](std::string_view cob_id, std::optional<NodeId> node) {
    const auto findings = check(read(pdo(true, cob_id, "1", "0x60410010"), node).dictionary);
    const auto* found = find(findings, "cob-id-restricted");
    return found == nullptr ? "" : std::string{name(found->severity)} + ": " + found->message;
  };

  EXPECT_EQ(
      finding("$NODEID+0x680", std::nullopt),
      "warning: 1800sub1: COB-ID $NODEID+0x680 is restricted (reserved) for nodes of 96..127");
  EXPECT_EQ(finding("$NODEID+0x680", 95_node), "");
  EXPECT_EQ(finding("$NODEID+0x680", 96_node),
            "error: 1800sub1: COB-ID 0x6E0 is restricted (reserved)");
  EXPECT_EQ(finding("$NODEID+0x580", std::nullopt),
            "error: 1800sub1: COB-ID $NODEID+0x580 is restricted (SDO responses) for nodes of "
            "1..127");
}

TEST(Check, ComparesCobIdsOfAKnownNodeAsTheyAre) {
  const auto device = pdo(true, "$NODEID+0x180", "1", "0x60410010") + entry("1801sub0", "5", "1") +
                      entry("1801sub1", "7", "0x185");

  EXPECT_TRUE(has(check(read(device, 5_node).dictionary), "cob-id-twice"));
  EXPECT_FALSE(has(check(read(device, 6_node).dictionary), "cob-id-twice"));
  EXPECT_FALSE(has(check(read(device, std::nullopt).dictionary), "cob-id-twice"));
}

TEST(Check, TwoRpdosMayShareACobId) {
  const auto findings =
      check(read(pdo(false, "$NODEID+0x200", "1", "0x60400010") + entry("1401sub0", "5", "1") +
                 entry("1401sub1", "7", "$NODEID+0x200"))
                .dictionary);

  ASSERT_TRUE(has(findings, "cob-id-twice"));
  EXPECT_EQ(find(findings, "cob-id-twice")->severity, Severity::warning);
}

TEST(Check, FindsTwoUsersOfOneCobId) {
  const auto twice = entry("1801sub0", "5", "1") + entry("1801sub1", "7", "$NODEID+0x180");
  const auto sync = entry("1005", "7", "0x80") + entry("1014", "7", "0x80");

  EXPECT_TRUE(has(check(read(pdo(true, "$NODEID+0x180", "1", "0x60410010") + twice).dictionary),
                  "cob-id-twice"));
  EXPECT_TRUE(has(check(read(sync).dictionary), "cob-id-twice"));
  EXPECT_TRUE(has(tpdo("0x60410010", "0x185"), "cob-id-absolute"));
  EXPECT_FALSE(has(tpdo("0x60410010"), "cob-id-absolute"));
}

TEST(Check, ComparesValuesWithLimits) {
  const auto limits = std::string{"LowLimit=-5\nHighLimit=5\n"};

  EXPECT_FALSE(
      has(check(read(entry("2000", "3", "-5") + limits).dictionary), "default-outside-limits"));
  EXPECT_TRUE(
      has(check(read(entry("2000", "3", "-6") + limits).dictionary), "default-outside-limits"));
  const auto value =
      check(read(entry("2000", "3", "0") + limits + "ParameterValue=6\n").dictionary);
  EXPECT_EQ(find(value, "value-outside-limits")->severity, Severity::error);
  EXPECT_TRUE(has(value, "parameter-value-in-eds"));
}

TEST(Check, ReportsABitRateThatTheDeviceHasNot) {
  const auto reported = [](std::string_view rates, std::string_view rate) {
    const auto file =
        read_eds("[DeviceInfo]\n" + std::string{rates} + "[DeviceComissioning]\n" +
                     "NodeID=5\nBaudrate=" + std::string{rate} + "\n[1000]\nDataType=7\n",
                 "t.dcf");
    const auto findings = check(file.dictionary);
    const auto* finding = find(findings, "baudrate-unsupported");
    return finding == nullptr ? std::string{} : to_string(*finding);
  };

  EXPECT_EQ(reported("BaudRate_500=1\nBaudRate_125=1\nBaudRate_250=0\n", "250"),
            "t.dcf:7:10: warning: Baudrate is 250 kbit/s; according to [DeviceInfo] the device has "
            "125, 500 [baudrate-unsupported]");
  EXPECT_EQ(reported("BaudRate_500=1\n", "500"), "");
  EXPECT_EQ(reported("BaudRate_500=1\n", "500000"), "") << "taken for bit/s";
  EXPECT_EQ(reported("", "250"), "") << "the file says nothing of them";
  EXPECT_EQ(reported("BaudRate_500=1\n", ""), "");
}

TEST(Check, NamesTheLimitThatAValueBreaks) {
  const auto message = [](std::string_view type, std::string_view value, std::string_view limits) {
    const auto findings = check(read(entry("2000", type, value) + std::string{limits}).dictionary);
    const auto* finding = find(findings, "default-outside-limits");
    return finding == nullptr ? std::string{} : finding->message;
  };

  EXPECT_EQ(message("3", "-6", "LowLimit=-5\nHighLimit=5\n"),
            "2000sub0: DefaultValue '-6' is below LowLimit -5; it is kept");
  EXPECT_EQ(message("7", "0xFF", "HighLimit=0x10\n"),
            "2000sub0: DefaultValue '0xFF' is above HighLimit 16; it is kept");
  EXPECT_EQ(message("0x1B", "0", "LowLimit=0xFFFFFFFFFFFFFFFF\n"),
            "2000sub0: DefaultValue '0' is below LowLimit 18446744073709551615; it is kept");
  EXPECT_EQ(message("8", "1.5", "LowLimit=0\nHighLimit=0.25\n"),
            "2000sub0: DefaultValue '1.5' is above HighLimit 0.25; it is kept");
}

TEST(Check, AValueThatIsNeverWrittenIsNotRefused) {
  const std::string value = "DataType=3\nHighLimit=5\nParameterValue=6\n";
  for (const std::string access :
       {"AccessType=ro\n", "AccessType=const\n", "AccessType=rw\nObjFlags=1\n"}) {
    const auto findings = check(read("[2000]\nParameterName=x\n" + value + access).dictionary);

    ASSERT_TRUE(has(findings, "value-outside-limits")) << access;
    EXPECT_EQ(find(findings, "value-outside-limits")->severity, Severity::note) << access;
  }
}

/// Returns the indices that the profile of a device type requires and that are missing in
/// `objects`.
std::vector<std::string> missing(std::string_view device_type, const std::string& objects = "",
                                 std::string_view rule = "profile-object-missing") {
  const auto text = "[1000]\nParameterName=t\nDataType=7\nAccessType=ro\nDefaultValue=" +
                    std::string{device_type} + "\n" + objects;
  std::vector<std::string> indices;
  for (const auto& finding : check(read_eds(text, "t.eds").dictionary)) {
    if (finding.rule != rule) continue;
    indices.push_back(finding.message.substr(finding.message.find("object 0x") + 9, 4));
  }
  return indices;
}

using Indices = std::vector<std::string>;

/// Makes a drive with these modes, with the objects of every drive and with the objects in `more`.
std::string drive(std::string_view modes, std::initializer_list<std::string_view> more = {}) {
  std::string text = entry("6502", "7", modes);
  for (const auto index : {"6040", "6041", "6060", "6061"}) text += entry(index, "6", "0");
  for (const auto index : more) text += entry(index, "7", "0");
  return text;
}

TEST(Check, DemandsTheChannelsThatAnIoModuleClaims) {
  EXPECT_EQ(missing("0x00010191"), (Indices{"6000"}));
  EXPECT_EQ(missing("0x00010191", entry("6000sub1", "5", "0")), Indices{});
  EXPECT_EQ(missing("0x00010191", entry("6100sub1", "6", "0")), Indices{});
  EXPECT_EQ(missing("0x000F0191"), (Indices{"6000", "6200", "6401", "6411"}));
  EXPECT_EQ(missing("0x000C0191", entry("6403sub1", "8", "0")), (Indices{"6411"}));
  EXPECT_EQ(missing("0x00000191"), Indices{});
}

TEST(Check, DemandsTheObjectsOfTheModesThatADriveClaims) {
  EXPECT_EQ(missing("0x00020192"), (Indices{"6040", "6041", "6060", "6061"}));
  EXPECT_EQ(missing("0x00020192", drive("0")), Indices{});
  EXPECT_EQ(missing("0x00020192", drive("0x01")), (Indices{"607A", "6064", "6081", "6083"}));
  EXPECT_EQ(missing("0x00020192", drive("0x81", {"6064", "6081", "6083"})), (Indices{"607A"}));
  EXPECT_EQ(missing("0x00010192", drive("0x02")),
            (Indices{"6042", "6043", "6044", "6046", "6048", "6049"}));
  EXPECT_EQ(missing("0x00020192", drive("0x04")), (Indices{"60FF", "606C"}));
  EXPECT_EQ(missing("0x00020192", drive("0x08")), (Indices{"6071"}));
  EXPECT_EQ(missing("0x00020192", drive("0x20", {"6098"})), (Indices{"6099"}));
  EXPECT_EQ(missing("0x00020192", drive("0x40", {"60C2"})), (Indices{"60C1"}));
  EXPECT_EQ(missing("0x00020192", drive("0x300", {"60FF", "6071"})), (Indices{"606C", "6077"}));
}

TEST(Check, AdvisesADriveToReportItsModesAndToTakeTheCycle) {
  const auto advised = [](const std::string& objects) {
    return missing("0x00020192", objects, "profile-object-advised");
  };

  EXPECT_EQ(advised(""), (Indices{"6502"}));
  EXPECT_EQ(advised(drive("0x80", {"607A", "6064"})), (Indices{"60C2"}));
  EXPECT_EQ(advised(drive("0x80", {"607A", "6064", "60C2"})), Indices{});
  EXPECT_EQ(advised(drive("0x01", {"607A", "6064", "6081", "6083"})), Indices{});
}

TEST(Check, LooksAtEachModuleOfADeviceOfSeveral) {
  EXPECT_EQ(missing("0xFFFF0192"), Indices{});  // the objects of each module are not known
  EXPECT_EQ(missing("0xFFFF0192", entry("67FF", "7", "0x00020192") +
                                      entry("6FFF", "7", "0x00010191") + drive("0x08", {"6071"})),
            (Indices{"6800"}));
}

// The objects of the third module are higher by 0x1000, so object 0x1000, which every device has,
// is not one of its channels.
TEST(Check, TheDeviceTypeIsNoChannelOfTheThirdModule) {
  EXPECT_EQ(missing("0xFFFF0191", entry("77FF", "7", "0x00030191")), (Indices{"7000", "7200"}));
}

TEST(Check, DemandsTheObjectsOfAnEncoder) {
  EXPECT_EQ(missing("0x00010196"),
            (Indices{"6000", "6500", "6501", "6503", "6504", "6507", "6004"}));
  EXPECT_EQ(missing("0x00020196").back(), "6502");
  EXPECT_EQ(missing("0x000A0196").back(), "6020");
  EXPECT_EQ(missing("0"), Indices{});
}

TEST(Check, ComparesIdentityAndMandatoryObjects) {
  const auto bare = check(read_eds(entry("2000", "5", "1"), "t.eds").dictionary);
  EXPECT_EQ(std::ranges::count(bare, "mandatory-object-missing", &Finding::rule), 3);

  const auto other = read_eds("[DeviceInfo]\nVendorNumber=2\n" + entry("1018sub1", "7", "3"), "t");
  EXPECT_TRUE(has(check(other.dictionary), "identity-mismatch"));
  const auto open = read_eds("[DeviceInfo]\nVendorNumber=2\n" + entry("1018sub1", "7", "0"), "t");
  EXPECT_FALSE(has(check(open.dictionary), "identity-mismatch"));  // 0 means not specified
}

}  // namespace
}  // namespace takt
