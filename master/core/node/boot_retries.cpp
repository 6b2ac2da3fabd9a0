#include "master/core/node/boot_retries.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace takt {
namespace {

constexpr Time default_reboot_delay = std::chrono::seconds{1};
constexpr std::uint8_t most_failed_boots = 20;  // the pause reaches its maximum earlier
constexpr std::uint16_t sync_length_emcy = 0x8240;

bool same_cause(const BootFailure& a, const BootFailure& b) noexcept {
  return a.step == b.step && a.fault == b.fault && a.abort_code == b.abort_code &&
         a.value == b.value && a.node_state == b.node_state;
}

/// Returns true if the boot has failed because a SYNC with counter came before 0x1019 of the node
/// was written. Some stacks keep this error until their next reset and do not enter OPERATIONAL.
/// After the reset, they know the counter.
bool met_counter_too_early(const BootFailure& failure) noexcept {
  return failure.action == BootAction::await_operational && failure.emcy == sync_length_emcy;
}

}  // namespace

void BootRetries::after_pause(BootRunner::From from, Time now) noexcept {
  from_ = from;
  at_ = now + pause();
}

Time BootRetries::pause() const noexcept {
  const Time first = plan_->reboot_delay > Time{} ? plan_->reboot_delay : default_reboot_delay;
  const Time longest = std::max(first, plan_->longest_reboot_delay);
  Time pause = first;
  for (int i = 0; i < failed_boots_ && pause < longest; ++i) pause *= 2;
  return std::min(pause, longest);
}

bool BootRetries::on_failure(const BootFailure& failure, Time now) noexcept {
  if (met_counter_too_early(failure) && !std::exchange(counter_error_retried_, true)) {
    at_ = now;
    return false;
  }
  if (failed_boots_ < most_failed_boots) ++failed_boots_;
  same_failures_ = same_cause(failure, last_failure_) ? same_failures_ + 1 : 1;
  last_failure_ = failure;
  return true;
}

void BootRetries::on_success() noexcept {
  same_failures_ = failed_boots_ = 0;
  counter_error_retried_ = false;
}

bool BootRetries::boots_up_repeatedly(Time now, BootState state) noexcept {
  constexpr Time window = std::chrono::seconds{10};
  constexpr std::uint32_t most_bootups = 5;
  if (now - bootups_since_ >= window) {
    bootups_since_ = now;
    bootups_ = 0;
  }
  const bool gave_up = state == BootState::failed && last_failure_.restarts != 0 &&
                       last_failure_.fault == SdoFault::cancelled;
  return ++bootups_ > most_bootups || gave_up;
}

bool BootRetries::is_reported(std::uint32_t number) noexcept { return std::has_single_bit(number); }

}  // namespace takt
