#include "test/boot/plant.hpp"
#include "test/support/folder.hpp"

// The order of the frames of a boot: restore, configuration, read-back, store, start. CiA 302-2.

namespace takt {
namespace {

using namespace test;
using Lines = std::vector<std::string>;

/// Records the actions of the master on node 5 in the format of candump: NMT commands, SDO
/// downloads and, with `reads_too`, SDO uploads. Also records the boot-up messages of the node.
class Story final : public sim::BusObserver {
 public:
  enum class Of : std::uint8_t { writes, reads_too };

  explicit Story(Plant& plant, Of what = Of::writes) : what_{what} { plant.world.observe(this); }

  void on_wire(const sim::WireFrame& seen) noexcept override {
    const Frame& frame = seen.frame;
    if (seen.result != sim::WireResult::sent || !wanted(frame)) return;
    char text[24];
    int size = std::snprintf(text, sizeof text, "%03X#", frame.id.id());
    for (std::uint8_t i = 0; i < frame.length; ++i) {
      size += std::snprintf(text + size, sizeof text - static_cast<std::size_t>(size), "%02X",
                            frame.data[i]);
    }
    lines.emplace_back(text);
  }

  Lines lines;

 private:
  bool wanted(const Frame& frame) const noexcept {
    if (frame.id == CobId::base(0)) return true;
    if (frame.id == CobId::base(0x705)) return frame.length == 1 && frame.data[0] == 0;
    if (frame.id != CobId::base(0x605)) return false;
    const unsigned command = frame.data[0] >> 5U;
    const bool reads = command == 2 || command == 3;  // CiA 301, 7.2.4.3.5, 7.2.4.3.6
    return what_ == Of::reads_too || !reads;
  }

  Of what_;
};

/// Sets a value that survives every reset, as if it had been stored long ago.
void stored_before(Plant& plant, ObjectKey key, std::uint64_t value) {
  sim::Object& object = *plant.device(5).objects().find(key);
  object.value = object.power_on = value;
}

/// Returns the lines from `first` on. The test fails if `first` is missing.
Lines from(const Lines& lines, const std::string& first) {
  const auto found = std::ranges::find(lines, first);
  EXPECT_NE(found, lines.end()) << first;
  return {found, lines.end()};
}

const std::string load = "605#231110016C6F6164";
const std::string save = "605#2310100173617665";
const std::string bootup = "705#00";
const std::string start = "000#0105";
const std::string preop = "000#8005";                  // before the first write
const std::string heartbeat = "605#2B17100064000000";  // every 100 ms
const std::string consumer = "605#231610012C017F00";   // consumer of the master's heartbeat, 300 ms
const std::string period = "605#2306100010270000";     // SYNC period, 10000 us

// restore, 0x1011

TEST(RestoreOrder, ResetsTheNodeAndWritesOnlyToWhatCameBack) {
  Plant plant{valve("restore_configuration: 1, sdo: [{index: 0x2000, value: 7}]")};
  stored_before(plant, {0x2001, 0}, 55);
  const Story story{plant};
  plant.run(4s);

  EXPECT_EQ(story.lines, (Lines{"000#8205", bootup, preop, load, "000#8105", bootup, preop,
                                heartbeat, consumer, period, "605#2B00200007000000", start}));
  EXPECT_EQ(plant.device(5).objects().number({0x2001, 0}), 100) << "the default";
  EXPECT_EQ(plant.node().boot, BootState::ready);
}

TEST(RestoreOrder, AsksWhoIsThereBeforeAndWhetherItIsBackAfterwards) {
  Plant plant{valve("restore_configuration: 1, revision_number: 0")};
  const Story story{plant, Story::Of::reads_too};
  plant.run(4s);

  const Lines before(story.lines.begin(), std::ranges::find(story.lines, load));
  EXPECT_EQ(before,
            (Lines{"000#8205", bootup, "605#4000100000000000", "605#4000100000000000",
                   "605#4018100100000000", "605#4018100200000000", "605#4018100400000000", preop}));
  Lines after = from(story.lines, load);
  ASSERT_GT(after.size(), 4U);
  after.resize(4);
  EXPECT_EQ(after, (Lines{load, "000#8105", bootup, "605#4000100000000000"}));
}

TEST(RestoreOrder, WaitsForABootUpThatComesLate) {
  sim::Fault late{.kind = sim::FaultKind::late_bootup, .node = 5_node};
  late.time = 1200ms;
  Plant plant{valve("restore_configuration: 1, sdo: [{index: 0x2000, value: 7}]"), {late}};
  const Story story{plant};
  plant.run(8s);

  const Lines after = from(story.lines, load);
  EXPECT_EQ(after, (Lines{load, "000#8105", bootup, preop, heartbeat, consumer, period,
                          "605#2B00200007000000", start}));
}

TEST(RestoreOrder, ThatIsRefusedChangesNothingAndStartsNothing) {
  sim::Fault refused{.kind = sim::FaultKind::refuse_write, .node = 5_node};
  refused.object = ObjectKey{0x1011, 1};
  refused.abort_code = 0x0800'0020;
  Plant plant{valve("restore_configuration: 1, sdo: [{index: 0x2000, value: 7}]"), {refused}};
  const Story story{plant};
  plant.run(1s);

  EXPECT_EQ(story.lines, (Lines{"000#8205", bootup, preop, load}));
  EXPECT_EQ(plant.node().boot, BootState::failed);
}

/// A write without an answer is not repeated, because it might act twice.
TEST(RestoreOrder, ThatIsNotAnsweredIsNotWrittenAgainByTheSameBoot) {
  sim::Fault mute{.kind = sim::FaultKind::mute_sdo, .node = 5_node};
  mute.object = ObjectKey{0x1011, 1};
  Plant plant{valve("restore_configuration: 1"), {mute}};
  const Story story{plant};
  plant.run(6s);

  ASSERT_GE(story.lines.size(), 5U);
  EXPECT_EQ(Lines(story.lines.begin(), story.lines.begin() + 5),
            (Lines{"000#8205", bootup, preop, load, "605#8011100100000405"}));
  EXPECT_EQ(std::ranges::count(story.lines, load), 1);
  EXPECT_EQ(std::ranges::count(story.lines, start), 0);
}

// store, 0x1010, and date, 0x1020

TEST(StoreOrder, ComesAfterAllThatWasWrittenAndBeforeTheStart) {
  Plant plant{
      valve("store_configuration: 1, configuration_date: 15000, configuration_time: 1234, "
            "tpdo: {1: {transmission: 5}}, sdo: [{index: 0x2000, value: 7}]")};
  const Story story{plant};
  plant.run(4s);

  EXPECT_EQ(story.lines, (Lines{"000#8205", bootup, preop, heartbeat, consumer, period,
                                "605#2B00200007000000",                          // sdo:
                                "605#23001801850100C0",                          // TPDO1 off
                                "605#2F00180205000000",                          // type 5
                                "605#2300180185010040",                          // TPDO1 on
                                "605#23201001983A0000", "605#23201002D2040000",  // date, time
                                save, start}));
}

TEST(StoreOrder, KeepsAConfigurationThatTheNextBootRestoresNothingOf) {
  Plant plant{
      valve("restore_configuration: 1, store_configuration: 1, configuration_date: 15000, "
            "configuration_time: 1234, sdo: [{index: 0x2000, value: 7}]")};
  Story story{plant};
  plant.run(4s);
  EXPECT_EQ(from(story.lines, load), (Lines{load, "000#8105", bootup, preop, heartbeat, consumer,
                                            period, "605#2B00200007000000", "605#23201001983A0000",
                                            "605#23201002D2040000", save, start}));

  story.lines.clear();
  plant.nmt(NmtCommand::reset_node, 5);
  plant.run(4s);
  EXPECT_EQ(story.lines, (Lines{"000#8105", bootup, start}));
  EXPECT_EQ(plant.device(5).objects().number({0x2000, 0}), 7);
}

/// The device has the date of another configuration. The master replaces that configuration
/// completely.
TEST(StoreOrder, ReplacesTheConfigurationOfAnotherDay) {
  Plant plant{
      valve("restore_configuration: 1, store_configuration: 1, configuration_date: 15000, "
            "configuration_time: 1234, sdo: [{index: 0x2000, value: 7}]")};
  stored_before(plant, {0x1020, 1}, 14999);
  stored_before(plant, {0x1020, 2}, 1234);
  stored_before(plant, {0x2001, 0}, 55);
  const Story story{plant};
  plant.run(4s);

  EXPECT_EQ(from(story.lines, load), (Lines{load, "000#8105", bootup, preop, heartbeat, consumer,
                                            period, "605#2B00200007000000", "605#23201001983A0000",
                                            "605#23201002D2040000", save, start}));
  EXPECT_EQ(plant.device(5).objects().number({0x2001, 0}), 100);
}

/// An ordered stop disarms the device but does not change the date of its configuration.
TEST(StoreOrder, ArmsTheDeviceAgainThoughItsConfigurationIsThere) {
  Plant plant{
      valve("store_configuration: 1, configuration_date: 15000, configuration_time: 1234, "
            "sdo: [{index: 0x2000, value: 7}]")};
  stored_before(plant, {0x1020, 1}, 15000);
  stored_before(plant, {0x1020, 2}, 1234);
  stored_before(plant, {0x1016, 1}, 0);
  const Story story{plant};
  plant.run(4s);

  EXPECT_EQ(std::ranges::count(story.lines, consumer), 1);
  EXPECT_EQ(std::ranges::count(story.lines, "605#2B00200007000000"), 0) << "that is there";
  EXPECT_EQ(plant.node().boot, BootState::ready);
}

TEST(StoreOrder, ThatIsRefusedLeavesTheNodeUnstarted) {
  sim::Fault refused{.kind = sim::FaultKind::refuse_write, .node = 5_node};
  refused.object = ObjectKey{0x1010, 1};
  refused.abort_code = 0x0606'0000;
  Plant plant{valve("store_configuration: 1, sdo: [{index: 0x2000, value: 7}]"), {refused}};
  const Story story{plant};
  plant.run(1s);

  EXPECT_EQ(story.lines, (Lines{"000#8205", bootup, preop, heartbeat, consumer, period,
                                "605#2B00200007000000", save}));
}

// verification

TEST(PdoOrder, IsOffWhileItChangesAndReadBackWhenItIsOn) {
  Plant plant{valve("tpdo: {1: {transmission: 5, mapping: [{index: 0x2012}, {index: 0x2010}]}}")};
  const Story story{plant, Story::Of::reads_too};
  plant.run(4s);

  EXPECT_EQ(from(story.lines, "605#23001801850100C0"),
            (Lines{"605#23001801850100C0",                          // off
                   "605#2F001A0000000000",                          // no entries
                   "605#23001A0110001220",                          // 2012:00, 16 bits
                   "605#23001A0210001020",                          // 2010:00, 16 bits
                   "605#2F001A0002000000",                          // two entries
                   "605#4000180100000000", "605#4000180200000000",  // what differs?
                   "605#4000180300000000", "605#4000180500000000",  //
                   "605#4000180200000000", "605#2F00180205000000",  // type 5
                   "605#4000180300000000", "605#4000180500000000",  //
                   "605#2300180185010040",                          // on
                   "605#4000180100000000", "605#40001A0000000000",  // read back
                   "605#40001A0100000000", "605#40001A0200000000", start}));
}

/// The device confirms the write of the mapping but keeps the old mapping.
TEST(PdoOrder, EndsWithTheReadBackWhereAWriteWasOnlyConfirmed) {
  sim::Fault deaf{.kind = sim::FaultKind::ignore_write, .node = 5_node};
  deaf.object = ObjectKey{0x1A00, 1};
  Plant plant{valve("tpdo: {1: {mapping: [{index: 0x2012}]}}"), {deaf}};
  const Story story{plant, Story::Of::reads_too};
  plant.run(1s);

  ASSERT_FALSE(story.lines.empty());
  EXPECT_EQ(story.lines.back(), "605#40001A0100000000");
  EXPECT_EQ(plant.node().boot, BootState::failed);
  EXPECT_NE(plant.text_of(EventKind::boot_failed).find("1A00:01"), std::string::npos)
      << plant.text_of(EventKind::boot_failed);
}

// concise DCF, 0x1F22

/// A file with a concise DCF for the network files of the tests.
class ConciseFile {
 public:
  explicit ConciseFile(const std::vector<std::uint8_t>& bytes)
      : path_{folder_.write("five.cdcf", {bytes.begin(), bytes.end()})} {}
  std::string key() const { return "configuration_file: " + path_.string(); }

 private:
  Folder folder_;
  std::filesystem::path path_;
};

/// The entries are 2001, a text of ten bytes in 2002, type 5 for TPDO1, 2000, and 2001 again.
const std::vector<std::uint8_t> five{5,    0,    0,    0,                               //
                                     0x01, 0x20, 0x00, 2,   0,   0,   0,   0x05, 0x00,  //
                                     0x02, 0x20, 0x00, 10,  0,   0,   0,   'l',  'o',
                                     'w',  'e',  'r',  ' ', 'l', 'e', 'f', 't',         //
                                     0x00, 0x18, 0x02, 1,   0,   0,   0,   0x05,        //
                                     0x00, 0x20, 0x00, 2,   0,   0,   0,   0x2C, 0x01,  //
                                     0x01, 0x20, 0x00, 2,   0,   0,   0,   0x58, 0x02};

TEST(ConciseOrder, IsThatOfTheFileWithEveryValueOnceMoreWhereTheFileHasItAgain) {
  const ConciseFile file{five};
  Plant plant{valve(file.key() + ", sdo: [{index: 0x2000, value: 7}]")};
  const Story story{plant};
  plant.run(4s);

  EXPECT_EQ(story.lines, (Lines{"000#8205", bootup, preop, heartbeat, consumer, period,
                                "605#2B01200005000000",  // 2001 = 5
                                "605#210220000A000000",  // 2002, 10 bytes
                                "605#006C6F776572206C", "605#1965667400000000",
                                "605#2B0020002C010000",  // 2000 = 300
                                "605#2B01200058020000",  // 2001 = 600
                                "605#2B00200007000000",  // the key `sdo` comes last
                                "605#23001801850100C0",  // PDOs are written in their own order
                                "605#2F00180205000000", "605#2300180185010040", start}));
}

TEST(ConciseOrder, EndsAtTheValueThatIsRefused) {
  sim::Fault refused{.kind = sim::FaultKind::refuse_write, .node = 5_node};
  refused.object = ObjectKey{0x2000, 0};
  refused.abort_code = 0x0609'0031;
  const ConciseFile file{five};
  Plant plant{valve(file.key()), {refused}};
  const Story story{plant};
  plant.run(1s);

  EXPECT_EQ(story.lines,
            (Lines{"000#8205", bootup, preop, heartbeat, consumer, period, "605#2B01200005000000",
                   "605#210220000A000000", "605#006C6F776572206C", "605#1965667400000000",
                   "605#2B0020002C010000"}));
  EXPECT_NE(plant.text_of(EventKind::boot_failed).find("2000:00"), std::string::npos);
}

TEST(ConciseOrder, IsRestoredBeforeAndStoredAfter) {
  const ConciseFile file{five};
  Plant plant{valve(file.key() + ", restore_configuration: 1, store_configuration: 1")};
  stored_before(plant, {0x2001, 0}, 5);
  const Story story{plant};
  plant.run(4s);

  EXPECT_EQ(story.lines, (Lines{"000#8205",
                                bootup,
                                preop,
                                load,
                                "000#8105",
                                bootup,
                                preop,
                                heartbeat,
                                consumer,
                                period,
                                "605#2B01200005000000",
                                "605#210220000A000000",
                                "605#006C6F776572206C",
                                "605#1965667400000000",
                                "605#2B0020002C010000",
                                "605#2B01200058020000",
                                "605#23001801850100C0",
                                "605#2F00180205000000",
                                "605#2300180185010040",
                                save,
                                start}));
}

}  // namespace
}  // namespace takt
