#include <gtest/gtest.h>

#include "master/sim/bus/sim_port.hpp"
#include "master/sim/bus/world.hpp"
#include "master/sim/device/device.hpp"
#include "test/unit/master/sim/device/sample_device.hpp"

namespace takt::sim {
namespace {

using namespace std::chrono_literals;

/// Two devices, a port of the master, and a record of everything on the wire.
class WorldFaults : public testing::Test, protected BusObserver {
 protected:
  void build(Faults faults, std::vector<DeviceTable> tables = {}) {
    if (tables.empty()) {
      tables = {communicating(5_node).pdo(0x1800, 0x4000'0185, 1, {0x20110020}).build(),
                communicating(6_node).build()};
    }
    world_ = std::make_unique<World>(tables, WorldOptions{.seed = 3, .faults = std::move(faults)});
    world_->observe(this);
    port_ = std::make_unique<SimPort>(*world_, RemotePortOptions{.tx_queue = 10});
  }
  void on_wire(const WireFrame& wire) noexcept override { wire_.push_back(wire); }

  void send(const Frame& frame) { port_->send({&frame, 1}); }
  void start_all() { send(make_frame(CobId::base(0), {1, 0})); }
  void read_vendor(std::uint8_t node) {
    send(make_frame(CobId::base(0x600u + node), {0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0}));
  }
  std::vector<WireFrame> of(std::uint32_t id) const {
    std::vector<WireFrame> found;
    for (const WireFrame& wire : wire_) {
      if (wire.frame.id == CobId::base(id)) found.push_back(wire);
    }
    return found;
  }
  std::size_t received(std::uint32_t id) {
    std::size_t count = 0;
    StampedFrame frame;
    while (port_->receive({&frame, 1}) == 1) count += frame.frame.id == CobId::base(id);
    return count;
  }

  std::unique_ptr<World> world_;
  std::unique_ptr<SimPort> port_;
  std::vector<WireFrame> wire_;
};

TEST_F(WorldFaults, PowerOffSilencesANodeAndPowerOnBootsIt) {
  build({{.kind = FaultKind::power_off, .node = 5_node, .at = 100ms, .until = 300ms}});
  port_->sleep_until(200ms);
  read_vendor(5);
  port_->sleep_until(290ms);
  EXPECT_TRUE(of(0x585).empty());

  port_->sleep_until(400ms);
  ASSERT_EQ(of(0x705).size(), 2u);
  EXPECT_EQ(of(0x705)[1].start, 350ms);
}

TEST_F(WorldFaults, LossTakesFramesOffOnlyOnTheWayToTheReceivers) {
  build({{.kind = FaultKind::loss, .node = 5_node, .probability = 1.0}});
  port_->sleep_until(100ms);

  EXPECT_EQ(of(0x705).size(), 1u);
  EXPECT_EQ(received(0x705), 0u);
}

TEST_F(WorldFaults, DuplicateDeliversTwice) {
  build({{.kind = FaultKind::duplicate, .node = 5_node, .probability = 1.0}});
  port_->sleep_until(100ms);

  EXPECT_EQ(received(0x705), 2u);
}

TEST_F(WorldFaults, MuteSdoLeavesOneNodeWithoutAnswers) {
  build({{.kind = FaultKind::mute_sdo, .node = 5_node}});
  port_->sleep_until(100ms);
  read_vendor(5);
  read_vendor(6);
  port_->sleep_until(200ms);

  EXPECT_TRUE(of(0x585).empty());
  EXPECT_EQ(of(0x586).size(), 1u);
}

TEST_F(WorldFaults, RefuseObjectGivesTheWantedAbortCode) {
  build({{.kind = FaultKind::refuse_object,
          .node = 5_node,
          .object = ObjectKey{0x1018, 1},
          .abort_code = 0x0606'0000}});
  port_->sleep_until(100ms);
  read_vendor(5);
  port_->sleep_until(200ms);

  EXPECT_EQ(of(0x585)[0].frame,
            make_frame(CobId::base(0x585), {0x80, 0x18, 0x10, 0x01, 0, 0, 0x06, 0x06}));
}

TEST_F(WorldFaults, OverrideValueReadsAsAnotherVendorUntilItEnds) {
  build({{.kind = FaultKind::override_value,
          .node = 5_node,
          .until = 150ms,
          .object = ObjectKey{0x1018, 1},
          .value = {std::byte{0x43}}}});
  port_->sleep_until(100ms);
  read_vendor(5);
  port_->sleep_until(200ms);
  read_vendor(5);
  port_->sleep_until(300ms);

  EXPECT_EQ(of(0x585)[0].frame.data[4], 0x43);
  EXPECT_EQ(of(0x585)[1].frame.data[4], 0x5A);
}

TEST_F(WorldFaults, SlowServerAnswersWithinItsTime) {
  build({{.kind = FaultKind::slow_sdo, .node = 5_node, .at = 100ms, .until = 1s, .time = 9ms}});
  for (Time at = 110ms; at < 1s; at += 10ms) {
    port_->sleep_until(at);
    read_vendor(5);
  }
  port_->sleep_until(1s);
  read_vendor(5);
  port_->sleep_until(1010ms);

  const auto requests = of(0x605);
  const auto answers = of(0x585);
  ASSERT_EQ(answers.size(), requests.size());
  Time longest{};
  for (std::size_t i = 0; i + 1 < answers.size(); ++i) {
    longest = std::max(longest, answers[i].start - requests[i].end);
  }
  EXPECT_GT(longest, 8ms);
  EXPECT_LE(longest, 10ms);
  EXPECT_LT(answers.back().start - requests.back().end, 1ms);
}

TEST_F(WorldFaults, LateBootUpComesLate) {
  build({{.kind = FaultKind::late_bootup, .node = 5_node, .time = 700ms}});
  port_->sleep_until(1s);

  EXPECT_EQ(of(0x706)[0].start, 50ms);
  EXPECT_EQ(of(0x705)[0].start, 750ms);
}

TEST_F(WorldFaults, QuirksOfATableBehaveAsFaults) {
  build({}, {communicating(5_node).quirk("no_bootup").build(),
             communicating(6_node).quirk("self_start").build(),
             communicating(7_node).quirk("late_bootup").build()});
  port_->sleep_until(1s);

  EXPECT_TRUE(of(0x705).empty());
  EXPECT_EQ(world_->device(6_node)->state(), DeviceState::operational);
  EXPECT_EQ(world_->device(7_node)->state(), DeviceState::initialising);
}

TEST_F(WorldFaults, BootUpStormRepeatsTheMessage) {
  build({{.kind = FaultKind::bootup_storm,
          .node = 5_node,
          .at = 100ms,
          .until = 200ms,
          .time = 10ms}});
  port_->sleep_until(1s);

  EXPECT_EQ(of(0x705).size(), 1u + 10u);
}

TEST_F(WorldFaults, BabblerOfALowIdentifierStarvesTheOthers) {
  build({{.kind = FaultKind::babble,
          .at = 100ms,
          .until = 200ms,
          .cob_id = CobId::base(0x001),
          .value = {std::byte{1}}}});
  port_->sleep_until(120ms);
  read_vendor(5);
  port_->sleep_until(199ms);
  EXPECT_TRUE(of(0x605).empty());
  EXPECT_GT(of(0x001).size(), 1000u);

  port_->sleep_until(300ms);
  EXPECT_EQ(of(0x605).size(), 1u);
  EXPECT_EQ(of(0x585).size(), 1u);
}

TEST_F(WorldFaults, DriftMovesHeartbeatsApart) {
  build({{.kind = FaultKind::drift, .node = 5_node, .at = 60ms, .ppm = 10'000}});
  port_->sleep_until(60ms);
  for (const NodeId node : {5_node, 6_node}) {
    send(make_frame(CobId::base(0x600u + node.value()), {0x2B, 0x17, 0x10, 0, 100, 0, 0, 0}));
  }
  port_->sleep_until(20s);

  EXPECT_NEAR(static_cast<double>(of(0x705).size()), 201.0, 2.0);  // 1 % more in 20 s
  EXPECT_NEAR(static_cast<double>(of(0x706).size()), 200.0, 1.0);
}

TEST_F(WorldFaults, AFullTransmitQueueIsEnobufs) {
  build({});
  port_->sleep_until(100ms);
  std::array<Frame, 12> frames{};
  frames.fill(make_frame(CobId::base(0x700), {}));

  const SendResult result = port_->send(frames);

  EXPECT_EQ(result.sent, 10u);
  EXPECT_EQ(result.error, ENOBUFS);
}

TEST_F(WorldFaults, MasterBusOffIsNewsAndEnds) {
  build({{.kind = FaultKind::bus_off, .at = 100ms}});
  port_->sleep_until(110ms);
  EXPECT_TRUE(port_->condition().bus_off);
  const Frame frame = make_frame(CobId::base(0x080), {});
  EXPECT_EQ(port_->send({&frame, 1}).error, ENETDOWN);

  port_->sleep_until(250ms);
  EXPECT_FALSE(port_->condition().bus_off);
  EXPECT_EQ(port_->send({&frame, 1}).sent, 1u);
}

TEST_F(WorldFaults, DeviceBusOffReactsAs1029SaysAndReportsItsReturn) {
  build({{.kind = FaultKind::bus_off, .node = 5_node, .at = 200ms}});
  port_->sleep_until(100ms);
  start_all();
  port_->sleep_until(300ms);

  EXPECT_EQ(world_->device(5_node)->state(), DeviceState::preoperational);
  EXPECT_EQ(world_->device(6_node)->state(), DeviceState::operational);
  ASSERT_EQ(of(0x085).size(), 1u);
  EXPECT_EQ(of(0x085)[0].frame.data[0], 0x40);
  EXPECT_EQ(of(0x085)[0].frame.data[1], 0x81);
}

TEST_F(WorldFaults, StallLetsTheMasterWakeLate) {
  build({{.kind = FaultKind::stall_master, .at = 100ms, .until = 150ms}});
  port_->sleep_until(99ms);
  port_->sleep_until(100ms);
  port_->sleep_until(101ms);

  EXPECT_EQ(port_->now(), 150ms);
}

TEST_F(WorldFaults, InterfaceDownReceivesNothing) {
  build({{.kind = FaultKind::interface_down, .at = 10ms, .until = 100ms}});
  port_->sleep_until(90ms);
  EXPECT_TRUE(port_->condition().interface_down);
  EXPECT_EQ(received(0x705), 0u);
  port_->sleep_until(110ms);
  EXPECT_FALSE(port_->condition().interface_down);
}

TEST_F(WorldFaults, TheEchoOfOwnSyncIsItsEndOnTheWire) {
  build({});
  port_->sleep_until(100ms);
  send(make_frame(CobId::base(0x080), {}));
  port_->sleep_until(101ms);

  EXPECT_EQ(port_->condition().last_sync_echo, 100ms + 48us);
  EXPECT_EQ(received(0x080), 0u) << "own frames do not come back";
}

TEST_F(WorldFaults, AWorldWithoutDevicesAcknowledges) {
  World world{{}, {}};
  SimPort port{world};
  const Frame frame = make_frame(CobId::base(0x080), {});
  port.send({&frame, 1});
  port.sleep_until(1ms);

  EXPECT_EQ(port.condition().last_sync_echo, 48us);
  EXPECT_EQ(world.bus().counters().frames, 1u);
}

TEST_F(WorldFaults, RandomFramesNeverStopADevice) {
  build({});
  Random random{99};
  port_->sleep_until(100ms);
  for (int i = 0; i < 20'000; ++i) {
    Frame frame{.id = CobId::base(random.below(4) == 0 ? 0x605 : random.below(0x800))};
    if (random.below(50) == 0) frame.id = CobId::extended(random.below(0x2000'0000));
    frame.length = static_cast<std::uint8_t>(random.below(9));
    frame.rtr = random.below(20) == 0;
    for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(random.next());
    send(frame);
    port_->sleep_until(port_->now() + 200us);
    received(0);
  }
  send(make_frame(CobId::base(0), {0x81, 5}));
  port_->sleep_until(port_->now() + 200ms);
  wire_.clear();
  read_vendor(5);
  port_->sleep_until(port_->now() + 10ms);
  EXPECT_EQ(of(0x585).size(), 1u);
}

}  // namespace
}  // namespace takt::sim
