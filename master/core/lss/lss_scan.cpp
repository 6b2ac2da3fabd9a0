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
  confirming_ = false;
  ask_below(32);
}

/// Asks for the highest unknown bit below `bit`. If there is none, the next question confirms the
/// whole part, and the devices go on to the next part.
void LssFastScan::ask_below(int bit) noexcept {
  const std::uint32_t mask = question_.part < confirmed_ ? ~0U : mask_[question_.part];
  do {
    --bit;
  } while (bit >= 0 && ((mask >> bit) & 1) != 0);
  confirming_ = bit < 0;
  question_.bit_check = static_cast<std::uint8_t>(confirming_ ? 0 : bit);
  if (confirming_) question_.next = static_cast<std::uint8_t>((question_.part + 1) % parts);
}

void LssFastScan::on_reaction(bool answered) noexcept {
  if (question_.bit_check == lss::FastScan::everybody) return on_anybody(answered);
  if (confirming_) return on_confirm(answered);
  const std::uint8_t bit = question_.bit_check;
  if (!answered) question_.number |= std::uint32_t{1} << bit;
  ask_below(bit);
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

/// Evaluates the confirmation of a part. If no device confirms it, an answer was lost or late and
/// was taken for a 1 or for the answer to the next question, or the devices have gone on to the
/// next part without a received answer. If bits of the part were given, there may also be no such
/// device. A lost answer makes an address too high. The scan finds a higher address next only if a
/// device has entered configuration state without a received answer.
void LssFastScan::on_confirm(bool answered) noexcept {
  const std::uint8_t part = question_.part;
  may_have_switched_ = may_have_switched_ || part + 1 == parts;
  if (answered) {
    address_[part] = question_.number;
    if (part >= confirmed_) doubtful_ = false;
    confirmed_ = std::max(confirmed_, static_cast<std::uint8_t>(part + 1));
    if (part + 1 < parts) return begin_part(static_cast<std::uint8_t>(part + 1));
    state_ = unheard_ && address_ > *unheard_ ? LssScanState::lost : LssScanState::found;
  } else if (!doubtful_ || part < confirmed_) {
    confirmed_ = std::min(confirmed_, part);
    if (part + 1 == parts) keep_unheard();
    start_over();
  } else {
    state_ = mask_[part] != 0 ? LssScanState::nobody : LssScanState::lost;
  }
}

void LssFastScan::keep_unheard() noexcept {
  LssAddress asked = address_;
  asked[parts - 1] = question_.number;
  if (!unheard_ || asked < *unheard_) unheard_ = asked;
}

/// Starts the scan again. Each confirmed part then needs only one question, and leads the devices
/// back to the part that has failed.
void LssFastScan::start_over() noexcept {
  if (restarts_ == most_restarts) {
    state_ = LssScanState::lost;
    return;
  }
  ++restarts_;
  doubtful_ = true;
  question_ = {};
}

void LssSlowScan::on_reaction(bool answered) noexcept {
  if (first_) {
    first_ = false;
    if (!answered) {
      state_ = LssScanState::nobody;
      return;
    }
  } else if (confirming_) {
    state_ = answered ? LssScanState::found : LssScanState::lost;
    return;
  } else {
    const std::size_t from = left_[2] != left_[3] ? 2 : 4;
    if (answered) {
      left_[from + 1] = question_[from + 1];
    } else {
      left_[from] = question_[from + 1] + 1;
    }
  }
  ask();
}

/// Asks for the lower half of the revision numbers, then of the serial numbers, and at the end for
/// the remaining address.
void LssSlowScan::ask() noexcept {
  question_ = left_;
  const std::size_t from = left_[2] != left_[3] ? 2 : 4;
  confirming_ = left_[from] == left_[from + 1];
  if (!confirming_) question_[from + 1] = left_[from] + (left_[from + 1] - left_[from]) / 2;
}

}  // namespace takt
