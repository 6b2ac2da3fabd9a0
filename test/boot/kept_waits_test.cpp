#include "eds_parser/print/plan/plan_waits.hpp"
#include "master/core/lss/lss_command.hpp"
#include "test/boot/plant.hpp"

// The master gives up after the time that the plan prints: not earlier, and not later than the
// first cycle in which it can detect this.

namespace takt {
namespace {

using namespace test;

constexpr Time cycle = 10ms;

/// Records the frames of one identifier and their times on the wire.
class Listener final : public sim::BusObserver {
 public:
  Listener(Plant& plant, std::uint32_t id) : id_{id} { plant.world.observe(this); }
  void on_wire(const sim::WireFrame& seen) noexcept override {
    if (seen.frame.id == CobId::base(id_)) heard.push_back(seen);
  }
  std::vector<sim::WireFrame> heard;

 private:
  std::uint32_t id_;
};

Time limit(const Plant& plant, const std::string& wait) {
  const std::vector<PlanWait> waits = plan_waits(plant.plan());
  const auto found = std::ranges::find(waits, wait, &PlanWait::wait);
  EXPECT_NE(found, waits.end()) << wait;
  return found == waits.end() ? never : found->limit;
}

void expect_kept(Time took, Time printed) {
  EXPECT_GE(took, printed - cycle);
  EXPECT_LE(took, printed + 2 * cycle);
}

/// Sends a request and returns the time until the reply, at most one minute.
Time reply_after(Plant& plant, const Request& request) {
  const Time asked = plant.world.now();
  plant.ask(request);
  while (plant.replies.empty() && plant.world.now() < asked + 1min) plant.run(cycle);
  EXPECT_EQ(plant.replies.size(), 1U);
  return plant.world.now() - asked;
}

sim::Fault mute(std::optional<ObjectKey> object = {}, Time at = {}) {
  sim::Fault out{.kind = sim::FaultKind::mute_sdo, .node = 5_node, .at = at};
  out.object = object;
  return out;
}

Request lss(LssOp op) {
  Request request{.kind = RequestKind::lss, .size = lss_command_bytes};
  pack({.op = op}, std::span{request.data}.first<lss_command_bytes>());
  return request;
}

TEST(KeptWaits, OfAnSdoAnswer) {
  Plant plant{valve("sdo_timeout_ms: 300"), {mute(ObjectKey{0x2000, 0})}};
  plant.run(3s);
  Listener listener{plant, 0x605};

  plant.ask({.kind = RequestKind::sdo_upload, .node = 5, .object = {0x2000, 0}});
  plant.run(1s);

  ASSERT_EQ(listener.heard.size(), 2U) << "the request and the abort";
  EXPECT_EQ(listener.heard[1].frame.data[0], 0x80);
  EXPECT_EQ(limit(plant, "sdo_answer"), 300ms);
  expect_kept(listener.heard[1].end - listener.heard[0].end, 300ms);
}

TEST(KeptWaits, OfAnObjectWithATimeOutOfItsOwn) {
  Plant plant{valve(), {mute(ObjectKey{0x1010, 1})}};
  plant.run(3s);
  Listener listener{plant, 0x605};

  plant.ask({.kind = RequestKind::sdo_upload, .node = 5, .object = {0x1010, 1}});
  plant.run(7s);

  ASSERT_EQ(listener.heard.size(), 2U);
  expect_kept(listener.heard[1].end - listener.heard[0].end, limit(plant, "sdo_object"));
}

TEST(KeptWaits, OfAProbe) {
  Plant plant{valve(), {mute()}};
  Listener listener{plant, 0x605};
  plant.run(3s);

  std::erase_if(listener.heard,
                [](const sim::WireFrame& seen) { return seen.frame.data[0] != 0x40; });
  ASSERT_GE(listener.heard.size(), 3U);
  for (std::size_t i = 1; i < 3; ++i) {
    expect_kept(listener.heard[i].end - listener.heard[i - 1].end, limit(plant, "sdo_probe"));
  }
}

TEST(KeptWaits, OfAClientThatReadsTheMasterAndFallsSilent) {
  Plant plant{valve()};
  sim::RemotePort& tool = plant.world.attach();
  plant.run(3s);
  Listener listener{plant, 0x5FF};

  const Frame name = make_frame(CobId::base(0x67F), {0x40, 0x08, 0x10, 0, 0, 0, 0, 0});
  tool.send({&name, 1}, plant.world.now());
  plant.run(3s);

  ASSERT_EQ(listener.heard.size(), 2U) << "the beginning of a segmented upload and the abort";
  EXPECT_EQ(listener.heard[0].frame.data[0], 0x41);
  EXPECT_EQ(listener.heard[1].frame.data[0], 0x80);
  expect_kept(listener.heard[1].end - listener.heard[0].end, limit(plant, "sdo_server"));
}

TEST(KeptWaits, OfAPdoThatIsAskedFor) {
  Plant plant{valve("tpdo: {1: {transmission: 253}}"),
              {{.kind = sim::FaultKind::mute_pdo, .node = 5_node}}};
  plant.run(3s);

  expect_kept(reply_after(plant, {.kind = RequestKind::pdo_poll, .node = 5, .object = {1, 0}}),
              limit(plant, "pdo_answer"));
  EXPECT_EQ(plant.replies[0].fault, SdoFault::timeout);
}

TEST(KeptWaits, OfLssServices) {
  Plant plant{valve()};
  plant.run(3s);
  const std::array<std::pair<LssOp, const char*>, 3> services{
      {{LssOp::inquire_vendor, "lss_answer"},
       {LssOp::store, "lss_store"},
       {LssOp::identify_unconfigured, "lss_all"}}};
  for (const auto& [op, wait] : services) {
    plant.replies.clear();
    expect_kept(reply_after(plant, lss(op)), limit(plant, wait));
    EXPECT_EQ(plant.replies[0].fault, SdoFault::lss_failed) << wait;
  }
}

TEST(KeptWaits, BetweenLooksForANodeWithoutId) {
  Plant plant{valve("lss: true"), {{.kind = sim::FaultKind::power_off, .node = 5_node}}};
  plant.world.attach();  // a node that acknowledges frames
  Listener listener{plant, 0x7E5};
  plant.run(6s);

  ASSERT_GE(listener.heard.size(), 6U);
  const Time waits_for_all = limit(plant, "lss_all");
  for (std::size_t i = 1; i < listener.heard.size(); ++i) {
    const bool second = i % 2 == 1;  // each scan asks twice for a device
    expect_kept(listener.heard[i].end - listener.heard[i - 1].end,
                waits_for_all + (second ? Time{} : limit(plant, "lss_look_again")));
  }
}

}  // namespace
}  // namespace takt
