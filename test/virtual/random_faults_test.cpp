#include <gtest/gtest.h>
#include <map>
#include <set>

#include "master/sim/random.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::Rig;

constexpr unsigned nodes = 4;
constexpr std::uint32_t time_to_live = 5;

/// Makes random faults of every kind for some seconds; the last one ends before 4 s.
sim::Faults random_faults(sim::Random& random) {
  using enum sim::FaultKind;
  constexpr std::array kinds{loss,           duplicate, delay,        error_frames,
                             power_off,      drift,     mute_sdo,     late_bootup,
                             no_heartbeat,   mute_pdo,  reset,        stall_master,
                             interface_down, bus_off,   bootup_storm, device_error};
  sim::Faults faults;
  for (int i = 0; i < 12; ++i) {
    sim::Fault fault;
    fault.kind = kinds[random.below(kinds.size())];
    fault.node = NodeId::from(random.below(nodes) + 1);
    fault.at = Time{500ms} + random.below(2500) * Time{1ms};
    fault.until = fault.at + random.below(400) * Time{1ms};
    fault.probability = 0.01 * random.below(30);
    fault.time = random.below(3000) * Time{1us} + Time{1ms};
    fault.ppm = static_cast<int>(random.below(2000)) - 1000;
    fault.emcy_code = 0x8130;
    faults.push_back(fault);
  }
  return faults;
}

/// An application that commands each axis with the number of the period, except while it "hangs".
class Application {
 public:
  explicit Application(std::uint64_t seed) : random_{seed} {}

  void on_cycle(Rig& rig) {
    const std::int64_t cycle = rig.world->now() / Time{2ms};
    if (hangs_for_ == 0 && random_.chance(0.01)) hangs_for_ = 2 + random_.below(20);
    if (hangs_for_ != 0) {
      --hangs_for_;
    } else {
      rig.command_all(0x000F, cycle & 0xFFFF, time_to_live);
    }
    if (!random_.chance(0.2)) return;
    Request request;
    request.id = ++asked;
    request.node = static_cast<std::uint8_t>(random_.below(nodes + 1) + 1);  // one is unused
    request.kind = random_.chance(0.1) ? RequestKind::nmt : RequestKind::sdo_upload;
    request.command = NmtCommand::start;
    request.object = {random_.chance(0.5) ? std::uint16_t{0x1018} : std::uint16_t{0x5FFF}, 1};
    request.timeout = 50ms;
    if (!rig.master->submit(request)) --asked;
  }
  void take_replies(Rig& rig) {
    for (Reply reply; rig.master->take(reply);) {
      EXPECT_TRUE(answered_.insert(reply.id).second) << "request answered twice";
    }
  }
  std::size_t answered() const { return answered_.size(); }

  std::uint64_t asked = 0;

 private:
  sim::Random random_;
  std::uint32_t hangs_for_ = 0;
  std::set<std::uint64_t> answered_;
};

/// Checks the rules for every image.
class ImageJudge {
 public:
  void operator()(const ImageView& image) {
    EXPECT_GT(image.cycle, cycle_);
    EXPECT_GT(image.publish_time, published_);
    EXPECT_GE(image.publish_time, image.sync_time);
    // Both values of a device come in one frame: 000F or 0002 with a target of the same moment.
    for (std::size_t axis = 0; axis < nodes; ++axis) {
      const std::int64_t word = image.values[axis];
      EXPECT_TRUE(word == 0x0F || word == 0x02 || word == 0) << word;
      EXPECT_LE(image.values[nodes + axis], static_cast<std::int64_t>(image.cycle & 0xFFFF));
    }
    cycle_ = image.cycle;
    published_ = image.publish_time;
  }

 private:
  std::uint64_t cycle_ = 0;
  Time published_{};
};

bool cuts_the_bus(const sim::Fault& fault) {
  return fault.kind == sim::FaultKind::bus_off || fault.kind == sim::FaultKind::interface_down;
}

/// No command may enable an RPDO on the wire after its time to live. The only exception are frames
/// that the interface had queued when the bus was cut off: it sends them afterwards, at most those
/// of one cycle.
void judge_outputs(const Rig& rig, Time start, long interruptions) {
  for (std::uint32_t node = 1; node <= nodes; ++node) {
    long stale = 0;
    for (const sim::WireFrame& wire : rig.recorder.with(0x200 + node)) {
      if (wire.frame.data[0] != 0x0F) continue;
      const std::int64_t commanded_in = wire.frame.data[2] | wire.frame.data[3] << 8;
      const std::int64_t sent_in = (wire.start - start) / Time{2ms};
      stale += sent_in - commanded_in > time_to_live + 1;
    }
    EXPECT_LE(stale, interruptions) << "node " << node;
  }
}

void judge_beat(const Rig& rig) {
  const auto syncs = rig.recorder.with(0x080);
  for (std::size_t i = 1; i < syncs.size(); ++i) {
    EXPECT_GE(syncs[i].start - syncs[i - 1].start, 500us) << "burst of SYNCs";
  }
}

class RandomFaults : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomFaults, LeaveTheMasterSane) {
  sim::Random random{GetParam()};
  test::RigOptions options;
  options.world.seed = GetParam();
  options.world.faults = random_faults(random);
  options.port.wake_jitter = 60us;
  options.port.spin_jitter = 5us;
  Rig rig{test::axes({.nodes = nodes}), options};
  rig.on_image = ImageJudge{};
  Application application{GetParam()};
  const Time start = rig.world->now();

  while (rig.world->now() < 5s) {
    application.on_cycle(rig);
    rig.cycle();
    application.take_replies(rig);
  }
  for (int i = 0; i < 2000 && !rig.all_ready(); ++i) rig.cycle();
  for (int i = 0; i < 100; ++i) {
    rig.cycle();
    application.take_replies(rig);
  }

  EXPECT_TRUE(rig.all_ready());
  EXPECT_EQ(application.answered(), application.asked);
  EXPECT_GT(application.asked, 100U);
  judge_outputs(rig, start, std::ranges::count_if(options.world.faults, cuts_the_bus));
  judge_beat(rig);

  rig.master->request_stop();
  const Time stop = rig.world->now();
  for (int i = 0; i < 10000 && !rig.master->finished(); ++i) rig.cycle();
  EXPECT_TRUE(rig.master->finished());
  EXPECT_LE(rig.world->now() - stop, rig.master->plan().stop_timeout);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomFaults, testing::Range(std::uint64_t{1}, std::uint64_t{41}));

}  // namespace
}  // namespace takt
