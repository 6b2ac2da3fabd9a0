#include "master/core/lss/lss_runner.hpp"

#include <algorithm>

namespace takt {
namespace {

/// Returns true if the addressed devices are in configuration state after this command.
bool leads_to_configuration(const LssCommand& command) noexcept {
  return (command.op == LssOp::switch_global && command.a == 1) ||
         command.op == LssOp::switch_selective;
}

}  // namespace

/// Returns true if the command may have brought a device into configuration state. Even a scan with
/// the outcome `lost` may have found one.
bool LssRunner::may_configure(const LssCommand& command, LssOutcome outcome) const noexcept {
  if (command.op != LssOp::fast_scan) return leads_to_configuration(command);
  return outcome != LssOutcome::nobody || master_.scan_may_have_switched();
}

void LssRunner::begin(std::span<const LssCommand> commands, Time timeout) noexcept {
  master_.cancel();
  count_ = std::min(commands.size(), most_commands);
  std::copy_n(commands.begin(), count_, commands_.begin());
  results_count_ = 0;
  timeout_ = timeout;
  if (configured_by_ == ConfiguredBy::this_list) configured_by_ = ConfiguredBy::earlier_list;
  state_ = count_ == 0 ? State::done : State::running;
}

void LssRunner::leave(Time now) noexcept {
  const bool needed = running() || configured_by_ != ConfiguredBy::nobody;
  master_.cancel();
  state_ = needed ? State::leaving : State::idle;
  if (needed) master_.begin({.op = LssOp::switch_global}, timeout_, now);
}

void LssRunner::on_frame(const Frame& frame, Time now, Outbox& out) noexcept {
  master_.on_frame(frame, now, out);
  step(now);
}

void LssRunner::on_time(Time now, Outbox& out) noexcept {
  step(now);
  master_.on_time(now, out);
  step(now);
}

void LssRunner::step(Time now) noexcept {
  if (!running()) return;
  if (const auto result = master_.take_result()) on_result(*result, now);
  if (state_ == State::running && master_.idle()) {
    master_.begin(commands_[results_count_], timeout_, now);
  }
}

void LssRunner::on_result(const LssResult& result, Time now) noexcept {
  if (state_ == State::leaving) {
    state_ = State::failed;
    configured_by_ = ConfiguredBy::nobody;
    return;
  }
  const LssCommand& command = commands_[results_count_];
  results_[results_count_++] = result;
  if (may_configure(command, result.outcome)) configured_by_ = ConfiguredBy::this_list;
  if (command.op == LssOp::switch_global && command.a == 0) configured_by_ = ConfiguredBy::nobody;
  if (result.outcome == LssOutcome::done) {
    if (results_count_ == count_) state_ = State::done;
    return;
  }
  const bool leaves = configured_by_ == ConfiguredBy::this_list;
  state_ = leaves ? State::leaving : State::failed;
  if (leaves) master_.begin({.op = LssOp::switch_global}, timeout_, now);
}

Time LssRunner::deadline() const noexcept {
  if (!running()) return never;
  return master_.idle() ? at_once : master_.deadline();
}

}  // namespace takt
