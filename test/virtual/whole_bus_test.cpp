#include <gtest/gtest.h>

#include "master/core/lss/lss_runner.hpp"
#include "master/sim/device/device.hpp"
#include "test/virtual/rig.hpp"

namespace takt::test {
namespace {

using namespace std::chrono_literals;

/// A device with LSS whose node-ID and serial number come from `id`.
DeviceTable lss_device(NodeId id) {
  const BusPlan plan = axes({.nodes = 1});
  DeviceTable table = loopback_device(id, plan.pdos.tpdos[0], plan.pdos.rpdos[0]);
  for (std::uint8_t sub = 2; sub <= 4; ++sub) {
    table.objects.push_back({.key = {0x1018, sub},
                             .type = DataType::unsigned32,
                             .access = Access::ro,
                             .value = sim::little_endian(sub == 4 ? id.value() : sub, 4),
                             .low_limit = {},
                             .high_limit = {}});
  }
  std::ranges::sort(table.objects, {}, &DeviceObject::key);
  table.quirks.push_back("lss");
  return table;
}

/// An LSS master alone on the bus, as `takt lss --bus` is.
class LssTool {
 public:
  explicit LssTool(sim::World& world) : world_{world}, port_{world} {}

  /// Runs the commands and returns their results.
  std::vector<LssResult> run(std::initializer_list<LssCommand> commands) {
    const std::vector<LssCommand> list{commands};
    LssRunner runner;
    runner.begin(list, Time{});
    Outbox out;
    while (runner.running()) {
      runner.on_time(world_.now(), out);
      port_.send(out.frames());
      out.clear();
      if (!port_.wait_frame(std::min(runner.deadline(), world_.now() + 100ms))) continue;
      std::array<StampedFrame, 16> frames;
      const std::size_t count = port_.receive(frames);
      for (const StampedFrame& got : std::span{frames}.first(count)) {
        runner.on_frame(got.frame, world_.now(), out);
      }
    }
    return {runner.results().begin(), runner.results().end()};
  }

 private:
  sim::World& world_;
  sim::SimPort port_;
};

/// Does the steps of `takt lss set-bitrate 250 --all --activate 100` one by one.
TEST(BitRateOfTheWholeBus, IsChangedInTwoDelaysOfSilence) {
  const std::array<DeviceTable, 3> devices{lss_device(1_node), lss_device(2_node),
                                           lss_device(3_node)};
  sim::World world{devices, {.bitrate = 1'000'000}};
  Recorder recorder;
  world.observe(&recorder);
  LssTool tool{world};
  world.advance_to(1s);

  const auto configured = tool.run({{.op = LssOp::switch_global, .a = 1},
                                    {.op = LssOp::configure_bit_timing, .b = 3, .several = true},
                                    {.op = LssOp::switch_global}});
  ASSERT_EQ(configured.size(), 3U);
  EXPECT_EQ(configured[1].outcome, LssOutcome::done);
  EXPECT_GE(recorder.with(0x7E4).size(), 1U) << "equal answers at once are one frame";

  const auto activated = tool.run(
      {{.op = LssOp::switch_global, .a = 1}, {.op = LssOp::activate_bit_timing, .numbers = {100}}});
  ASSERT_EQ(activated.back().outcome, LssOutcome::done);
  const Time begun = world.now();
  const std::size_t frames = recorder.frames.size();
  world.advance_to(begun + 100ms);
  world.set_bitrate(250'000);
  world.advance_to(begun + 199ms);
  EXPECT_EQ(recorder.frames.size(), frames) << "nobody speaks for two delays";
  world.advance_to(begun + 210ms);

  tool.run({{.op = LssOp::switch_global}});
  for (std::uint32_t node = 1; node <= 3; ++node) {
    const auto reported = tool.run({{.op = LssOp::switch_selective, .numbers = {0x15A, 2, 3, node}},
                                    {.op = LssOp::inquire_node_id},
                                    {.op = LssOp::switch_global}});
    ASSERT_EQ(reported.size(), 3U) << "device " << node << " speaks at the new bit rate";
    EXPECT_EQ(reported[1].numbers[0], node);
  }
}

TEST(TimeOfDay, OfEveryDeviceThatTakesItIsThatOfTheMaster) {
  BusPlan plan = axes({.nodes = 2});
  plan.time.period = 1s;
  RigOptions options;
  for (std::size_t i = 0; i < 2; ++i) {
    DeviceTable table = loopback_device(plan.nodes[i].id, plan.pdos.tpdos[i], plan.pdos.rpdos[i]);
    const std::uint32_t takes = i == 0 ? 0x8000'0100 : 0x0000'0100;
    table.objects.push_back({.key = {0x1012, 0},
                             .type = DataType::unsigned32,
                             .access = Access::rw,
                             .value = sim::little_endian(takes, 4),
                             .low_limit = {},
                             .high_limit = {}});
    std::ranges::sort(table.objects, {}, &DeviceObject::key);
    options.devices.push_back(std::move(table));
  }
  Rig rig{std::move(plan), std::move(options)};
  ASSERT_TRUE(rig.boot());
  rig.run(2500);

  const Time now = rig.world->now();
  const auto of_first = rig.world->device(1_node)->time_of_day().now_ms(now);
  // The world begins at 2026-01-01, 15341 days after 1984-01-01.
  constexpr std::int64_t begin_ms = 15'341LL * 86'400'000;
  ASSERT_TRUE(of_first);
  EXPECT_NEAR(static_cast<double>(static_cast<std::int64_t>(*of_first) - begin_ms),
              static_cast<double>(now / 1ms), 1.0);
  EXPECT_FALSE(rig.world->device(2_node)->time_of_day().now_ms(now)) << "it was not told to";
}

}  // namespace
}  // namespace takt::test
