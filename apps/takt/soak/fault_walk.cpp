#include "apps/takt/soak/fault_walk.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace takt::soak {
namespace {

using namespace std::chrono_literals;
using sim::Fault;
using sim::FaultKind;

constexpr std::array<Time, 5> mean_pauses{20ms, 100ms, 300ms, 1s, 4s};  // mean time between faults
constexpr std::array<std::uint32_t, 5> aborts{0x0602'0000, 0x0800'0000, 0x0800'0022, 0x0504'0000,
                                              0x0609'0030};
constexpr std::array<ObjectKey, 6> objects{
    {{0x1000, 0}, {0x1017, 0}, {0x1400, 1}, {0x1600, 0}, {0x1800, 1}, {0x1A00, 0}}};

class Walk {
 public:
  Walk(const BusPlan& plan, sim::Random random, Time from, Time until, int slowness)
      : plan_{plan},
        random_{random},
        now_{from},
        end_{until},
        slowness_{slowness},
        other_until_(128) {}

  sim::Faults take() {
    for (; now_ < end_; now_ += pause()) {
      if (random_.chance(0.1)) mean_pause_ = mean_pauses[random_.below(mean_pauses.size())];
      step();
    }
    return std::move(faults_);
  }

 private:
  Time pause() { return Time{1ms} + slowness_ * Time{below(2 * mean_pause_.count())}; }
  Time::rep below(Time::rep limit) {
    return static_cast<Time::rep>(random_.next() % static_cast<std::uint64_t>(limit));
  }
  /// Returns the duration of a fault: mostly up to 300 ms, sometimes up to 3 s.
  Time span() { return Time{1ms} + Time{below(Time{random_.chance(0.1) ? 3s : 300ms}.count())}; }
  NodeId node() {
    return plan_.nodes[random_.below(static_cast<std::uint32_t>(plan_.nodes.size()))].id;
  }

  void add(Fault fault, Time at) {
    if (at >= end_) return;
    fault.at = at;
    fault.until = std::min(at + span(), end_);
    faults_.push_back(std::move(fault));
  }

  void step() {
    switch (random_.below(10)) {
      case 0:
        return reset_while_booting();
      case 1:
        return exchange_device();
      case 2:
        return emcy_storm();
      case 3:
        return babble();
      case 4:
        return refuse();
      default:
        return single();
    }
  }

  void single() {
    using enum FaultKind;
    constexpr std::array kinds{
        loss,         duplicate,    delay,       error_frames, power_off,     drift,
        mute_sdo,     slow_sdo,     no_bootup,   late_bootup,  no_heartbeat,  bootup_storm,
        self_start,   no_start,     mute_pdo,    device_error, reset,         bus_off,
        stall_master, stall_master, no_guarding, stuck_toggle, fixed_mapping, interface_down};
    Fault fault{.kind = kinds[random_.below(kinds.size())]};
    if (random_.chance(0.8)) fault.node = node();
    fault.probability = random_.chance(0.1) ? 1.0 : 0.01 * random_.below(40);
    fault.time = Time{100us} + Time{below(Time{5ms}.count())};
    fault.ppm = static_cast<int>(random_.below(4000)) - 2000;
    fault.emcy_code = static_cast<std::uint16_t>(1 + random_.below(0xFFFF));
    add(fault, now_);
  }

  void reset_while_booting() {
    const NodeId who = node();
    const std::uint32_t times = 1 + random_.below(6);
    for (Time at = now_; at < now_ + times * Time{120ms}; at += Time{below(Time{240ms}.count())}) {
      add({.kind = random_.chance(0.7) ? FaultKind::reset : FaultKind::power_off, .node = who}, at);
    }
  }

  /// Replaces a device by one with the same node-ID and another vendor, product, revision or serial
  /// number.
  void exchange_device() {
    const NodeId who = node();
    if (other_until_[who.value()] > now_) return;
    const auto sub = static_cast<std::uint8_t>(1 + random_.below(4));
    Fault other{.kind = FaultKind::override_value, .node = who, .object = ObjectKey{0x1018, sub}};
    for (int i = 0; i < 4; ++i) other.value.push_back(std::byte(random_.below(256)));
    add({.kind = FaultKind::power_off, .node = who}, now_);
    add(other, now_);
    Fault& added = faults_.back();
    added.until = std::min(end_, now_ + span() + span());
    other_until_[who.value()] = added.until;
    add({.kind = FaultKind::power_off, .node = who}, added.until - Time{1ms});
  }

  void emcy_storm() {
    const NodeId who = node();
    const std::uint32_t times = 10 + random_.below(100);
    for (std::uint32_t i = 0; i < times; ++i) {
      Fault fault{.kind = FaultKind::device_error, .node = who};
      fault.emcy_code = static_cast<std::uint16_t>(1 + random_.below(0xFFFF));
      add(fault, now_ + i * Time{500us});
    }
  }

  void babble() {
    Fault fault{.kind = FaultKind::babble, .time = Time{50us} + Time{below(Time{4ms}.count())}};
    const bool own = random_.chance(0.5) && !plan_.pdos.tpdos.empty();
    const auto row = random_.below(static_cast<std::uint32_t>(plan_.pdos.tpdos.size()));
    fault.cob_id = own ? plan_.pdos.tpdos[row].cob_id : CobId::base(random_.below(0x800));
    const std::uint32_t bytes = random_.below(9);
    for (std::uint32_t i = 0; i < bytes; ++i) {
      fault.value.push_back(std::byte(random_.below(256)));
    }
    if (random_.chance(0.2)) fault.time = Time{};
    add(fault, now_);
  }

  void refuse() {
    using enum FaultKind;
    constexpr std::array kinds{refuse_object, refuse_write, ignore_write, mute_sdo};
    add({.kind = kinds[random_.below(kinds.size())],
         .node = node(),
         .object = objects[random_.below(objects.size())],
         .abort_code = aborts[random_.below(aborts.size())]},
        now_);
  }

  const BusPlan& plan_;
  sim::Random random_;
  Time now_;
  Time end_;
  int slowness_;
  Time mean_pause_ = 300ms;
  // Time until which another device replaces the node, indexed by node-ID.
  std::vector<Time> other_until_;
  sim::Faults faults_;
};

}  // namespace

sim::Faults fault_walk(const BusPlan& plan, sim::Random random, Time from, Time until,
                       int slowness) {
  return Walk{plan, random, from, until, slowness}.take();
}

}  // namespace takt::soak
