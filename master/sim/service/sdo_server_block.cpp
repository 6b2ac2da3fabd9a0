#include "master/sim/service/sdo_server_block.hpp"

#include <algorithm>

namespace takt::sim {
namespace {

constexpr std::size_t per_segment = 7;
constexpr std::size_t longest = 16u << 20;

}  // namespace

std::uint16_t block_crc(std::span<const std::byte> data) noexcept {
  unsigned rest = 0;
  for (const std::byte byte : data) {
    for (int bit = 7; bit >= 0; --bit) {
      const unsigned in = std::to_integer<unsigned>(byte) >> bit & 1u;
      const bool carry = ((rest >> 15 & 1u) ^ in) != 0;
      rest = (rest << 1 & 0xFFFFu) ^ (carry ? 0x1021u : 0u);
    }
  }
  return static_cast<std::uint16_t>(rest);
}

void BlockReceiver::begin(bool crc, std::uint8_t segments, bool size_known,
                          std::size_t size) noexcept {
  *this = {};
  crc_ = crc;
  segments_ = segments;
  size_known_ = size_known;
  size_ = size;
}

BlockReceiver::Then BlockReceiver::refuse(Abort code) noexcept {
  code_ = code;
  return Then::abort;
}

BlockReceiver::Then BlockReceiver::on_segment(const SdoBytes& frame, const SdoFaults& faults,
                                              std::vector<std::byte>& data) {
  const std::uint8_t number = frame[0] & 0x7F;
  const bool last = (frame[0] & 0x80) != 0;
  if (number == 0 || number > segments_) return refuse(Abort::sequence);
  ++total_;
  if (faults.silent_after != 0 && total_ > faults.silent_after) return Then::wait;
  if (faults.abort_after != 0 && total_ > faults.abort_after) return refuse(Abort::general);
  if (deaf_once_ && total_ == faults.lose_segment) {
    deaf_once_ = false;
    in_block_ = true;
    return Then::wait;
  }
  in_block_ = true;
  if (number == got_ + 1) {
    if (data.size() + per_segment > longest) return refuse(Abort::memory);
    if (size_known_ && data.size() >= size_ && size_ != 0) return refuse(Abort::too_long);
    const auto bytes = std::as_bytes(std::span{frame}).subspan(1);
    data.insert(data.end(), bytes.begin(), bytes.end());
    got_ = number;
    all_ = last;
  } else if (faults.early_confirm && number > got_ + 1 && got_ != 0) {
    return Then::confirm;
  }
  return last || number == segments_ ? Then::confirm : Then::wait;
}

SdoBytes BlockReceiver::confirmation(const SdoFaults& faults) noexcept {
  const auto received = static_cast<std::uint8_t>(got_ + (faults.wrong_ackseq ? 1 : 0));
  got_ = 0;
  in_block_ = false;
  if (faults.block_size >= 1 && faults.block_size <= 127) segments_ = faults.block_size;
  return {0xA2, received, segments_, 0, 0, 0, 0, 0};
}

BlockReceiver::Then BlockReceiver::on_silence() noexcept {
  if (!in_block_ || got_ == 0) return refuse(Abort::timeout);
  return Then::confirm;
}

BlockReceiver::Then BlockReceiver::on_end(const SdoBytes& frame, std::vector<std::byte>& data) {
  if ((frame[0] & 0xE3) != 0xC1) return refuse(Abort::command);
  const std::size_t unused = frame[0] >> 2 & 7u;
  if (unused > data.size()) return refuse(Abort::command);
  data.erase(data.end() - static_cast<std::ptrdiff_t>(unused), data.end());
  if (size_known_ && size_ != 0 && data.size() != size_) {
    return refuse(data.size() > size_ ? Abort::too_long : Abort::too_short);
  }
  const auto reported = static_cast<std::uint16_t>(frame[1] | frame[2] << 8);
  if (crc_ && reported != block_crc(data)) return refuse(Abort::crc);
  return Then::finish;
}

void BlockSender::begin(bool crc, std::uint8_t segments, std::size_t size) noexcept {
  *this = {};
  crc_ = crc;
  segments_ = segments;
  size_ = size;
}

bool BlockSender::next(std::span<const std::byte> data, const SdoFaults& faults,
                       SdoBytes& segment) noexcept {
  const std::size_t at = base_ + sent_ * per_segment;
  const bool any = sent_ == 0 || at < size_;
  if (sent_ == segments_ || !any) return false;
  if (faults.silent_after != 0 && total_ >= faults.silent_after) return false;
  ++sent_;
  ++total_;
  const std::size_t count = std::min(per_segment, size_ - at);
  segment = {};
  segment[0] = static_cast<std::uint8_t>(sent_ | (at + per_segment >= size_ ? 0x80 : 0));
  for (std::size_t i = 0; i < count; ++i)
    segment[1 + i] = std::to_integer<std::uint8_t>(data[at + i]);
  if (!lose_once_ || total_ != faults.lose_segment) return true;
  lose_once_ = false;
  return next(data, faults, segment);
}

bool BlockSender::on_confirm(const SdoBytes& frame) noexcept {
  const std::uint8_t received = frame[1];
  if (received > sent_) {
    code_ = Abort::sequence;
    return false;
  }
  if (frame[2] == 0 || frame[2] > 127) {
    code_ = Abort::block_size;
    return false;
  }
  const bool was_last = base_ + sent_ * per_segment >= size_;
  all_confirmed_ = was_last && received == sent_;
  base_ += received * per_segment;
  segments_ = frame[2];
  sent_ = 0;
  return true;
}

SdoBytes BlockSender::end(std::span<const std::byte> data, const SdoFaults& faults) const noexcept {
  const std::size_t in_last = size_ == 0 ? 0 : (size_ - 1) % per_segment + 1;
  const unsigned unused = static_cast<unsigned>(per_segment - in_last);
  unsigned crc = crc_ ? block_crc(data) : 0u;
  if (faults.wrong_crc) crc ^= 1u;
  return {static_cast<std::uint8_t>(0xC1u | unused << 2),
          static_cast<std::uint8_t>(crc & 0xFFu),
          static_cast<std::uint8_t>(crc >> 8),
          0,
          0,
          0,
          0,
          0};
}

}  // namespace takt::sim
