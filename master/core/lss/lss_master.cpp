#include "master/core/lss/lss_master.hpp"

#include <algorithm>

#include "eds_parser/table/waits.hpp"

namespace takt {
namespace {

/// Returns the command specifier of the answers to a service; std::nullopt if it has no answer.
std::optional<lss::Service> answer_of(LssOp op) noexcept {
  switch (op) {
    case LssOp::switch_global:
    case LssOp::activate_bit_timing:
      return std::nullopt;
    case LssOp::switch_selective:
      return lss::Service::selected;
    case LssOp::identify:
    case LssOp::fast_scan:
    case LssOp::slow_scan:
      return lss::Service::identified;
    case LssOp::identify_unconfigured:
      return lss::Service::unconfigured;
    default:
      return static_cast<lss::Service>(op);  // the answer repeats the command specifier
  }
}

}  // namespace

void LssMaster::begin(const LssCommand& command, Time timeout, Time now) noexcept {
  command_ = command;
  result_ = {.op = command.op};
  timeout_ = timeout > Time{} ? timeout : default_timeout(command.op);
  send_at_ = std::max(send_at_, now);
  pace_ = Pace::quick;
  slowest_ = Time{};
  if (command.op == LssOp::fast_scan) {
    const auto& numbers = command.numbers;
    fast_ = LssFastScan{{numbers[0], numbers[1], numbers[2], numbers[3]},
                        {numbers[4], numbers[5], numbers[6], numbers[7]}};
  } else if (command.op == LssOp::slow_scan) {
    begin_slow_scan();
  }
  ask();
}

void LssMaster::begin_slow_scan() noexcept {
  std::array<std::uint32_t, 6> ranges{};
  std::copy_n(command_.numbers.begin(), ranges.size(), ranges.begin());
  slow_ = LssSlowScan{ranges};
}

/// Prepares the frames of the next question.
void LssMaster::ask() noexcept {
  count_ = next_ = 0;
  phase_ = Phase::sending;
  wait_for_ = command_.several ? Wait::all_answers : Wait::first_answer;
  if (!answer_of(command_.op)) wait_for_ = Wait::none;
  const auto service = static_cast<lss::Service>(command_.op);
  const auto& numbers = command_.numbers;
  switch (command_.op) {
    case LssOp::switch_global:
    case LssOp::configure_node_id:
      return put(lss::request(service, command_.a));
    case LssOp::activate_bit_timing:
      return put(lss::request(service, numbers[0]));
    case LssOp::configure_bit_timing:
      return put(lss::request(service, command_.a | std::uint32_t{command_.b} << 8));
    case LssOp::switch_selective:
      wait_for_ = Wait::first_answer;
      for (std::uint8_t i = 0; i < 4; ++i) put(lss::request(service, numbers[i], i));
      return;
    case LssOp::identify_unconfigured:
      wait_for_ = Wait::all_answers;
      return put(lss::request(service));
    case LssOp::identify:
    case LssOp::fast_scan:
    case LssOp::slow_scan:
      return ask_scan();
    default:
      return put(lss::request(service));
  }
}

void LssMaster::ask_scan() noexcept {
  wait_for_ = Wait::all_answers;
  if (command_.op == LssOp::fast_scan) return put(lss::request(fast_.question()));
  for (std::uint8_t i = 0; i < 6; ++i) {
    const std::uint32_t number =
        command_.op == LssOp::slow_scan ? slow_.question()[i] : command_.numbers[i];
    put(lss::request(lss::Service::identify, number, i));
  }
}

bool LssMaster::expects(const lss::Answer& answer) const noexcept {
  const auto service = answer_of(command_.op);
  return service && answer.is(*service);
}

void LssMaster::on_frame(const Frame& frame, Time now, Outbox& /*out*/) noexcept {
  if (!awaits_answers()) return;
  const auto answer = lss::decode_answer(frame);
  if (!answer || !expects(*answer)) return;
  phase_ = Phase::answered;
  slowest_ = std::max(slowest_, now - asked_at_);
  const bool configures = command_.op == LssOp::configure_node_id ||
                          command_.op == LssOp::configure_bit_timing || command_.op == LssOp::store;
  if (configures && result_.error == 0) {
    result_.error = answer->error;
    result_.specific = answer->specific;
  } else if (!configures) {
    result_.numbers[0] = answer->number;
  }
  if (command_.op == LssOp::inquire_node_id) result_.numbers[0] &= 0xFF;
  if (wait_for_ == Wait::first_answer) on_reaction(true, now);
}

void LssMaster::on_time(Time now, Outbox& out) noexcept {
  if (phase_ == Phase::idle) return;  // This is the case in nearly every cycle.
  if (awaits_answers() && now >= wait_until_) on_reaction(phase_ == Phase::answered, now);
  if (phase_ != Phase::sending || now < send_at_ || !out.push(frames_[next_])) return;
  ++next_;
  ++result_.frames;
  send_at_ = now + gap;
  if (next_ == count_) sent_all(now);
}

void LssMaster::sent_all(Time now) noexcept {
  asked_at_ = now;
  if (wait_for_ == Wait::none) return finish(LssOutcome::done);
  phase_ = Phase::waiting;
  wait_until_ = now + wait();
}

Time LssMaster::wait() const noexcept {
  const bool doubtful =
      command_.op == LssOp::fast_scan ? fast_.doubtful() : pace_ == Pace::full_timeout;
  if (!scans() || slowest_ == Time{} || doubtful) return timeout_;
  return std::min(timeout_, std::max(waits::lss_shortest, 3 * slowest_));
}

/// Evaluates a question when the time for answers is over or the expected answer has come.
void LssMaster::on_reaction(bool answered, Time now) noexcept {
  send_at_ = std::max(send_at_, now);
  if (scans()) return on_scan_reaction(answered);
  if (answered) return finish(result_.error == 0 ? LssOutcome::done : LssOutcome::refused);
  const bool asks = command_.op == LssOp::identify || command_.op == LssOp::identify_unconfigured;
  finish(asks ? LssOutcome::nobody : LssOutcome::silent);
}

void LssMaster::on_scan_reaction(bool answered) noexcept {
  if (command_.op == LssOp::fast_scan) {
    fast_.on_reaction(answered);
    return end_scan(fast_.state(), fast_.address());
  }
  slow_.on_reaction(answered);
  if (slow_.state() == LssScanState::lost && pace_ == Pace::quick) {
    pace_ = Pace::full_timeout;
    begin_slow_scan();
  }
  end_scan(slow_.state(), slow_.address());
}

void LssMaster::end_scan(LssScanState state, const LssAddress& address) noexcept {
  switch (state) {
    case LssScanState::running:
      return ask();
    case LssScanState::found:
      result_.numbers = address;
      return finish(LssOutcome::done);
    case LssScanState::nobody:
      result_.numbers = {};
      return finish(LssOutcome::nobody);
    case LssScanState::lost:
      result_.numbers = {};
      return finish(LssOutcome::lost);
  }
}

void LssMaster::finish(LssOutcome outcome) noexcept {
  result_.outcome = outcome;
  phase_ = Phase::over;
}

std::optional<LssResult> LssMaster::take_result() noexcept {
  if (phase_ != Phase::over) return {};
  phase_ = Phase::idle;
  return result_;
}

Time LssMaster::deadline() const noexcept {
  switch (phase_) {
    case Phase::idle:
      return never;
    case Phase::sending:
      return send_at_;
    case Phase::waiting:
    case Phase::answered:
      return wait_until_;
    case Phase::over:
      return at_once;
  }
  return never;
}

}  // namespace takt
