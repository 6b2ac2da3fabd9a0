#include "apps/takt/simulate/program/virtual_daemon.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "master/attach.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t daemon_room = 400;   // messages: 200 kB, the default of a Linux socket
constexpr Time longest_round_step = 60us;  // longest step of the front thread's round
constexpr Time longest_wake_up = 80us;

/// Discards waiting frames: a process receives no frame that came before it opened its socket.
void drain(StagedPort& port) {
  std::array<StampedFrame, 64> frames;
  while (port.receive(frames) != 0) {
  }
}

}  // namespace

VirtualDaemon::VirtualDaemon(const BusPlan& plan, StagedPort& port, VirtualLcm& lcm,
                             const Clocks& clocks, sim::Random random)
    : plan_{plan},
      port_{port},
      clocks_{clocks},
      random_{random},
      lcm_{lcm.join(daemon_room)},
      transport_{lcm_, Channels{plan.name}} {}

void VirtualDaemon::start() {
  session_ = static_cast<std::int64_t>(random_.next() >> 2 | 1U);
  drain(port_);
  master_ = std::make_unique<MasterRun>(plan_);
  master_->attach(port_);
  master_->begin();
  bridge_ = std::make_unique<Bridge>(
      *master_, transport_, clocks_,
      BridgeOptions{
          .session = session_, .interface = "virtual", .realtime = "virtual", .motions = true},
      [this](const Notice& notice) {
        if (hears_.notice) hears_.notice(notice);
      });
  bridge_->register_guest(*this);
  for (const std::string& channel : bridge_->channels().heard()) lcm_.subscribe(channel);
  round_ = {.next_image = [this] { return master_->next_publish(); },
            .serve =
                [this] {
                  bridge_->serve();
                  return bridge_->next_message();
                },
            .wait = [this](Time next, Time latest) { wait(next, latest); }};
  if (round_hook_) round_hook_(round_);
  wake_ = port_.now() + random_.up_to(longest_round_step);
  waits_ = false;
  stalled_until_ = {};
}

void VirtualDaemon::kill() {
  lcm_.close();
  bridge_.reset();
  master_.reset();
  wake_ = never;
}

Time VirtualDaemon::next() const noexcept {
  if (!runs()) return never;
  const Time wake = waits_ ? std::min(wake_, lcm_.next_arrival()) : wake_;
  return std::max(wake, stalled_until_);
}

void VirtualDaemon::act(Time now) {
  if (std::exchange(waits_, false)) {
    wake_ = now + random_.up_to(longest_wake_up);
    return;
  }
  wake_ = now + random_.up_to(longest_round_step);
  round_.step();
}

void VirtualDaemon::wait(Time next_image, Time latest) noexcept {
  const Time now = port_.now();
  const Time pause = std::max(Time{}, std::min(latest - now, pause_before_image(now, next_image)));
  wake_ = now + pause;
  waits_ = true;
}

void VirtualDaemon::see(const ImageView& image) {
  if (hears_.image) hears_.image(image, port_.now());
}

void VirtualDaemon::hear(const Event& event) {
  if (hears_.event) hears_.event(event);
}

}  // namespace takt
