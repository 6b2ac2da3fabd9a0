// One mistake in a network file gives exactly one error, which names the mistake.
#include <algorithm>
#include <gtest/gtest.h>
#include <ostream>
#include <string>
#include <vector>

#include "eds_parser/network_file/load_network.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

struct Mistake {
  std::string what;      ///< text in the good file
  std::string wrong;     ///< wrong text in its place
  std::string reported;  ///< text in the error message
};
std::ostream& operator<<(std::ostream& out, const Mistake& mistake) { return out << mistake.wrong; }

const std::string good =
    "bus: {name: lift, bitrate_kbit: 1000}\n"
    "master: {node_id: 127, sync_period: 4000, heartbeat_producer: 100}\n"
    "nodes:\n"
    "  z:\n"
    "    node_id: 5\n"
    "    dcf: " TAKT_SOURCE_DIR
    "/share/eds/takt_drive402.eds\n"
    "    profile: cia402\n"
    "    units: {position: {scale: 1.0e-6, unit: m}, velocity: {scale: 1.0e-6, unit: m/s}}\n"
    "    limits: {position: [-1, 1], velocity: 2}\n"
    "    on_timeout: {fallback: quick_stop, after: 50}\n"
    "    tpdo:\n"
    "      1: {transmission: 1, cob_id: auto, mapping: [{index: 0x6041}, {index: 0x6064}]}\n"
    "      2: {transmission: 1, mapping: [{index: 0x606C}]}\n"
    "    rpdo:\n"
    "      1: {transmission: 1, cob_id: auto, mapping: [{index: 0x6040}, {index: 0x607A}]}\n"
    "      2: {transmission: 1, mapping: [{index: 0x6060}]}\n"
    "    sdo: [{index: 0x6081, value: 1000}]\n";

std::vector<std::string> errors_of(const std::string& yaml) {
  const test::Folder folder;
  std::vector<std::string> errors;
  for (const Finding& finding : load_network(folder.write("net.yaml", yaml)).findings) {
    if (finding.severity == Severity::error) errors.push_back(to_string(finding));
  }
  return errors;
}

TEST(OneCause, IsMissingInTheGoodFile) { EXPECT_EQ(errors_of(good), (std::vector<std::string>{})); }

class OneCause : public testing::TestWithParam<Mistake> {};

TEST_P(OneCause, GivesOneErrorThatNamesIt) {
  std::string yaml = good;
  const std::size_t at = yaml.find(GetParam().what);
  ASSERT_NE(at, std::string::npos);
  yaml.replace(at, GetParam().what.size(), GetParam().wrong);

  const std::vector<std::string> errors = errors_of(yaml);

  ASSERT_EQ(errors.size(), 1U) << (errors.empty() ? "" : errors[0] + "\n" + errors.back());
  EXPECT_NE(errors[0].find(GetParam().reported), std::string::npos) << errors[0];
}

INSTANTIATE_TEST_SUITE_P(
    Of, OneCause,
    testing::Values(
        Mistake{"nodes:", "nodse:", "unknown section `nodse`"},
        Mistake{"master:", "mastr:", "did you mean `master`"},
        Mistake{"    dcf:", "    dfc:", "did you mean `dcf`"},
        Mistake{"    dcf:", "    dcff:", "did you mean `dcf`"},
        Mistake{"node_id: 5", "nodeid: 5", "did you mean `node_id`"},
        Mistake{"node_id: 5", "node_di: 5", "did you mean `node_id`"},
        Mistake{"value: 1000", "valeu: 1000", "did you mean `value`"},
        Mistake{"value: 1000", "vlue: 1000", "did you mean `value`"},
        Mistake{"{index: 0x606C}", "{indx: 0x606C}", "did you mean `index`"},
        Mistake{"takt_drive402.eds", "takt_drive403.eds", "not found"},
        Mistake{"/share/eds/takt_drive402.eds", "/README.md", "the file is not an EDS or DCF"},
        Mistake{"node_id: 5", "node_id: five", "`node_id`"},
        Mistake{"node_id: 5", "node_id: 200", "1..127"},
        Mistake{"node_id: 5", "node_id: 127", "is the master's"},
        Mistake{"    node_id: 5\n", "", "lacks `node_id`"},
        Mistake{"{index: 0x607A}", "{index: 0x6064}", "can only be read"},
        Mistake{"{index: 0x6064}", "{index: 0x5063}", "5063"},
        Mistake{"{index: 0x6064}", "{index: 6064}", "did you mean 0x6064"},
        Mistake{"{index: 0x606C}", "{index: 0x1008}", "not PDO-mappable"},
        Mistake{"index: 0x6081, value: 1000", "index: 0x6041, value: 1", "can only be read"},
        Mistake{"value: 1000", "value: 5000000000", "0..4294967295"},
        Mistake{"value: 1000", "value: fast", "takes a number"},
        Mistake{"cob_id: auto", "cob_id: 0x80", "is SYNC"},
        Mistake{"transmission: 1,", "transmission: 245,", "245"},
        Mistake{"position: [-1, 1]", "position: [1, -1]", "position"},
        Mistake{"scale: 1.0e-6", "scale: 0", "scale"},
        Mistake{"fallback: quick_stop", "fallback: stop_quick", "fallback"},
        Mistake{"profile: cia402", "profile: cia404", "profile"},
        Mistake{"sync_period: 4000", "sync_periode: 4000", "did you mean `sync_period`"},
        // A limit is not to blame for an output or a unit that has an error itself.
        Mistake{"{index: 0x607A}", "{index: 607A}", "`607A` is hexadecimal without 0x"},
        Mistake{"{index: 0x607A}", "{index: 607Ah}", "`607Ah` is not a whole number"},
        Mistake{"{index: 0x607A}", "{index: 0x6O7A}", "`0x6O7A` is not a whole number"},
        Mistake{"{index: 0x607A}", "{index: 0x607A}, {index: 0x60FF}", "maps 80 bits"},
        Mistake{"    units:", "    unts:", "did you mean `units`"},
        Mistake{"units: {position:", "units: {positon:", "did you mean `position`"},
        Mistake{"{scale: 1.0e-6, unit: m}", "{unit: m, scale: 1 um}", "`1 um` is not a number"},
        Mistake{"{scale: 1.0e-6, unit: m}", "micrometers", "has to be a map"},
        // entries of lists
        Mistake{"index: 0x6081,", "index: 0x1018, sub_index: 0A,",
                "`0A` is hexadecimal without 0x"},
        Mistake{"    sdo: [", "    sdo_timeouts: [{index: 1F5A, timeout_ms: 9}]\n    sdo: [",
                "`1F5A` is hexadecimal without 0x: write 0x1F5A"},
        Mistake{"    sdo: [", "    sdo_timeouts: [{index: 0x1F5A, timeout_ms: 9 s}]\n    sdo: [",
                "`9 s` is not a whole number"},
        Mistake{"    sdo: [", "    sdo_timeouts: [{indx: 0x1F5A, timeout_ms: 9}]\n    sdo: [",
                "did you mean `index`"},
        Mistake{"    sdo: [", "    sdo_timeouts: [{timeout_ms: 9}]\n    sdo: [", "lacks `index`"},
        Mistake{"    sdo: [", "    sdo_timeouts: [{index: 0x1F5A}]\n    sdo: [",
                "lacks `timeout_ms`"},
        Mistake{"    sdo: [", "    sdo_channel: {request: 0x645, answer: abc}\n    sdo: [",
                "`abc` is not a whole number"}));

}  // namespace
}  // namespace takt
