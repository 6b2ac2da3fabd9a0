#include "master/core/lss/lss_scan.hpp"

#include <algorithm>

namespace takt {
namespace {

constexpr std::uint8_t parts = 4;
constexpr std::uint8_t most_restarts = 4;

}  // namespace

void LssFastScan::begin_part(std::uint8_t part) noexcept {
  const std::uint32_t number = part < confirmed_ ? address_[part] : known_[part] & mask_[part];
  question_ = {.number = number, .part = part, .next = part};
  ask_below(32);
}

/// Asks for the highest unknown bit below `bit`. If there is none, the next question confirms the
/// whole part, and the devices go on to the next part.
void LssFastScan::ask_below(int bit) noexcept {
  const std::uint32_t mask = question_.part < confirmed_ ? ~0U : mask_[question_.part];
  do {
    --bit;
  } while (bit >= 0 && ((mask >> bit) & 1) != 0);
  asks_ = bit < 0 ? Asks::part : Asks::bit;
  question_.bit_check = static_cast<std::uint8_t>(std::max(bit, 0));
  if (asks_ == Asks::part) question_.next = static_cast<std::uint8_t>((question_.part + 1) % parts);
}

void LssFastScan::on_reaction(bool answered) noexcept {
  switch (asks_) {
    case Asks::anybody:
      return on_anybody(answered);
    case Asks::bit:
      if (!answered) question_.number |= std::uint32_t{1} << question_.bit_check;
      return ask_below(question_.bit_check);
    case Asks::part:
      return on_part(answered);
  }
}

/// Evaluates the first question. A single lost or late answer must not hide all devices, so only
/// the second silence counts.
void LssFastScan::on_anybody(bool answered) noexcept {
  if (answered) {
    doubtful_ = restarts_ != 0;
    return begin_part(0);
  }
  if (doubtful_) state_ = restarts_ == 0 ? LssScanState::nobody : LssScanState::lost;
  doubtful_ = true;
}

/// Evaluates the confirmation of a part. If no device confirms it, there are three explanations: an
/// earlier answer was lost (and counted as a 1), an answer was so late that it counted for the next
/// question, or the devices have received the confirmation and only their answer was lost. If bits
/// of the part were given, there may also be no such device. A lost answer makes the address too
/// high. If a later try finds a higher address than the unconfirmed one, a device has entered
/// configuration state although its answer was lost.
void LssFastScan::on_part(bool answered) noexcept {
  const std::uint8_t part = question_.part;
  may_have_switched_ = may_have_switched_ || part + 1 == parts;
  if (answered) {
    address_[part] = question_.number;
    if (part >= confirmed_) doubtful_ = false;
    confirmed_ = std::max(confirmed_, static_cast<std::uint8_t>(part + 1));
    if (part + 1 < parts) return begin_part(static_cast<std::uint8_t>(part + 1));
    state_ = unanswered_ && address_ > *unanswered_ ? LssScanState::lost : LssScanState::found;
  } else if (!doubtful_ || part < confirmed_) {
    confirmed_ = std::min(confirmed_, part);
    if (part + 1 == parts) keep_unanswered();
    start_over();
  } else {
    state_ = mask_[part] != 0 ? LssScanState::nobody : LssScanState::lost;
  }
}

void LssFastScan::keep_unanswered() noexcept {
  LssAddress asked = address_;
  asked[parts - 1] = question_.number;
  if (!unanswered_ || asked < *unanswered_) unanswered_ = asked;
}

void LssFastScan::ask_anybody() noexcept {
  question_ = {};
  asks_ = Asks::anybody;
}

/// Starts the scan again. Each part that is already confirmed then needs only one question, which
/// brings the devices back to the part that has failed.
void LssFastScan::start_over() noexcept {
  if (restarts_ == most_restarts) {
    state_ = LssScanState::lost;
    return;
  }
  ++restarts_;
  doubtful_ = true;
  ask_anybody();
}

void LssSlowScan::on_reaction(bool answered) noexcept {
  switch (asks_) {
    case Asks::everything:
      if (!answered) {
        state_ = LssScanState::nobody;
        return;
      }
      break;
    case Asks::lower_half:
      if (answered) {
        left_[halved() + 1] = question_[halved() + 1];
      } else {
        left_[halved()] = question_[halved() + 1] + 1;
      }
      break;
    case Asks::address:
      state_ = answered ? LssScanState::found : LssScanState::lost;
      return;
  }
  ask();
}

/// Asks for the lower half of the revision numbers, then of the serial numbers, and at the end for
/// the remaining address.
void LssSlowScan::ask() noexcept {
  question_ = left_;
  const std::uint32_t lowest = left_[halved()];
  const std::uint32_t highest = left_[halved() + 1];
  asks_ = lowest == highest ? Asks::address : Asks::lower_half;
  if (asks_ == Asks::lower_half) question_[halved() + 1] = lowest + (highest - lowest) / 2;
}

}  // namespace takt
