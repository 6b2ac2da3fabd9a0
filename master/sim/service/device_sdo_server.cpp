#include "master/sim/service/device_sdo_server.hpp"

#include <algorithm>
#include <array>

#include "master/wire/bytes.hpp"

namespace takt::sim {
namespace {

constexpr Time session_limit = std::chrono::seconds{1};
constexpr Time block_timeout = std::chrono::milliseconds{700};  // within a sub-block
constexpr std::size_t buffer_limit = 1 << 20;
constexpr std::uint8_t toggle_bit = 0x10;

std::span<const std::byte> bytes_from(const Frame& frame, std::size_t first,
                                      std::size_t count) noexcept {
  return std::as_bytes(std::span{frame.data}).subspan(first, count);
}

std::array<std::byte, 4> little_endian(std::uint32_t value) noexcept {
  return {std::byte(value & 0xFF), std::byte(value >> 8 & 0xFF), std::byte(value >> 16 & 0xFF),
          std::byte(value >> 24)};
}

}  // namespace

SdoServer::SdoServer(Dictionary& dictionary, NodeId node, const SdoFaults& faults)
    : dictionary_{&dictionary},
      faults_{&faults},
      request_id_{CobId::base(0x600u + node.value())},
      answer_id_{CobId::base(0x580u + node.value())} {
  buffer_.reserve(256);
}

void SdoServer::reset() noexcept {
  state_ = State::idle;
  deadline_ = next_segment_ = never;
}

void SdoServer::on_frame(const Frame& frame, Time now, Transmitter& out) noexcept {
  if (frame.length != 8 || frame.rtr) return;
  const bool blocks = state_ >= State::block_receiving;
  if (blocks && dictionary_->is_mute(key_)) return;
  if (state_ == State::block_receiving && frame.data[0] != 0x80) {
    const auto then = receiver_.awaits_end() ? receiver_.on_end(frame.data, buffer_)
                                             : receiver_.on_segment(frame.data, *faults_, buffer_);
    return block_received(then, now, out);
  }
  if (blocks && frame.data[0] >> 5 == 5) return on_block_upload(frame, now, out);
  switch (frame.data[0] >> 5) {
    case 0:
      return download_segment(frame, now, out);
    case 1:
    case 2:
    case 5:
    case 6:
      return on_initiate(frame, now, out);
    case 3:
      return upload_segment(frame, now, out);
    case 4:
      return reset();
    default:
      return abort(Abort::command, now, out);
  }
}

/// A new request within a transfer aborts the transfer; the client has to repeat its request.
void SdoServer::on_initiate(const Frame& frame, Time now, Transmitter& out) noexcept {
  if (state_ != State::idle) return abort(Abort::command, now, out);
  key_ = {static_cast<std::uint16_t>(frame.data[1] | frame.data[2] << 8), frame.data[3]};
  if (dictionary_->is_mute(key_)) return;
  const unsigned command = frame.data[0] >> 5;
  if (command == 1) return start_download(frame, now, out);
  if (command == 2) return start_upload(now, out);
  if (command >= 5 && faults_->mute_block) return;
  const bool begins = (frame.data[0] & (command == 5 ? 3u : 1u)) == 0;
  if (!begins || faults_->refuse_block) return abort(Abort::command, now, out);
  if (command == 5) return start_block_upload(frame, now, out);
  start_block_download(frame, now, out);
}

void SdoServer::start_upload(Time now, Transmitter& out) noexcept {
  std::span<const std::byte> data;
  const Abort refused = dictionary_->read(key_, now, data);
  if (refused != Abort::none) return abort(refused, now, out);
  if (!data.empty() && data.size() <= 4) {
    const auto reported = std::max<std::size_t>(data.size(), faults_->pad_expedited);
    const auto unused = static_cast<unsigned>(4 - std::min<std::size_t>(reported, 4));
    const unsigned command = faults_->no_size ? 0x42u : 0x43u | unused << 2;
    return answer(static_cast<std::uint8_t>(command), data, now, out);
  }
  buffer_.assign(data.begin(), data.end());
  state_ = State::uploading;
  toggle_ = false;
  done_ = 0;
  deadline_ = now + session_limit;
  answer(faults_->no_size ? 0x40 : 0x41, little_endian(announced(buffer_.size())), now, out);
}

std::uint32_t SdoServer::announced(std::size_t size) const noexcept {
  if (faults_->no_size) return 0;
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(size) + faults_->announce_more);
}

void SdoServer::upload_segment(const Frame& frame, Time now, Transmitter& out) noexcept {
  if (state_ != State::uploading) return abort(Abort::command, now, out);
  if (dictionary_->is_mute(key_)) return;
  if (((frame.data[0] & toggle_bit) != 0) != toggle_) return abort(Abort::toggle, now, out);
  const std::size_t count = std::min<std::size_t>(buffer_.size() - done_, 7);
  const bool last = done_ + count == buffer_.size();
  Frame segment{.id = answer_id_, .length = 8};
  segment.data[0] = static_cast<std::uint8_t>((toggle_ ? toggle_bit : 0) | (7 - count) << 1 |
                                              static_cast<unsigned>(last));
  for (std::size_t i = 0; i < count; ++i) {
    segment.data[1 + i] = std::to_integer<std::uint8_t>(buffer_[done_ + i]);
  }
  done_ += count;
  toggle_ = !toggle_;
  deadline_ = now + session_limit;
  if (last) reset();
  send(segment, now, out);
}

void SdoServer::start_download(const Frame& frame, Time now, Transmitter& out) noexcept {
  const bool expedited = (frame.data[0] & 0x02) != 0;
  const bool size_reported = (frame.data[0] & 0x01) != 0;
  if (!expedited) return start_segmented_download(frame, now, out);
  std::size_t size = 4;
  if (size_reported) {
    size -= (frame.data[0] >> 2) & 3;
  } else {
    std::size_t width = 0;
    if (dictionary_->width(key_, width) == Abort::none && width != 0 && width < 4) size = width;
  }
  const Abort refused = dictionary_->write(key_, now, bytes_from(frame, 4, size));
  if (refused != Abort::none) return abort(refused, now, out);
  confirm(0x60, now, out);
}

void SdoServer::start_segmented_download(const Frame& frame, Time now, Transmitter& out) noexcept {
  const Abort refused = take_size(frame, (frame.data[0] & 0x01) != 0);
  if (refused != Abort::none) return abort(refused, now, out);
  state_ = State::downloading;
  toggle_ = false;
  buffer_.clear();
  deadline_ = now + session_limit;
  confirm(0x60, now, out);
}

/// Takes the size of a download, if the client reports it. Returns the reason to refuse the
/// download.
Abort SdoServer::take_size(const Frame& frame, bool reported) noexcept {
  size_known_ = reported;
  size_ = reported ? load_le<std::uint32_t>(std::span{frame.data}.subspan(4)) : 0;
  std::size_t width = 0;
  const Abort refused = dictionary_->width(key_, width);
  if (refused != Abort::none || !reported) return refused;
  if (width == 0) return size_ > buffer_limit ? Abort::memory : Abort::none;
  if (size_ > width) return Abort::too_long;
  return size_ < width ? Abort::too_short : Abort::none;
}

void SdoServer::download_segment(const Frame& frame, Time now, Transmitter& out) noexcept {
  if (state_ != State::downloading) return abort(Abort::command, now, out);
  if (dictionary_->is_mute(key_)) return;
  if (((frame.data[0] & toggle_bit) != 0) != toggle_) return abort(Abort::toggle, now, out);
  const std::size_t count = 7u - ((frame.data[0] >> 1) & 7u);
  if (size_known_ && buffer_.size() + count > size_) return abort(Abort::too_long, now, out);
  if (buffer_.size() + count > buffer_limit) return abort(Abort::memory, now, out);
  const auto data = bytes_from(frame, 1, count);
  buffer_.insert(buffer_.end(), data.begin(), data.end());
  deadline_ = now + session_limit;
  if ((frame.data[0] & 1) != 0) return finish_download(now, out);
  confirm(toggle_ ? 0x30 : 0x20, now, out);
  toggle_ = !toggle_;
}

void SdoServer::finish_download(Time now, Transmitter& out) noexcept {
  if (size_known_ && buffer_.size() < size_) return abort(Abort::too_short, now, out);
  const Abort refused = dictionary_->write(key_, now, buffer_);
  if (refused != Abort::none) return abort(refused, now, out);
  confirm(toggle_ ? 0x30 : 0x20, now, out);
  reset();
}

void SdoServer::start_block_download(const Frame& frame, Time now, Transmitter& out) noexcept {
  const Abort refused = take_size(frame, (frame.data[0] & 0x02) != 0);
  if (refused != Abort::none) return abort(refused, now, out);
  const bool crc = (frame.data[0] & 0x04) != 0 && !faults_->no_crc;
  buffer_.clear();
  receiver_.begin(crc, faults_->block_size, size_known_, size_);
  state_ = State::block_receiving;
  deadline_ = now + session_limit;
  const std::byte segments{faults_->wrong_block_size ? std::uint8_t{0} : faults_->block_size};
  answer(crc ? 0xA4 : 0xA0, {&segments, 1}, now, out);
}

void SdoServer::block_received(BlockReceiver::Then then, Time now, Transmitter& out) noexcept {
  using Then = BlockReceiver::Then;
  deadline_ = now + (then == Then::wait ? block_timeout : session_limit);
  if (then == Then::abort) return abort(receiver_.code(), now, out);
  if (then == Then::confirm) return reply(receiver_.confirmation(*faults_), now, out);
  if (then != Then::finish) return;
  if (faults_->wrong_crc) return abort(Abort::crc, now, out);
  const Abort refused = dictionary_->write(key_, now, buffer_);
  if (refused != Abort::none) return abort(refused, now, out);
  reset();
  confirm(0xA1, now, out);
}

void SdoServer::start_block_upload(const Frame& frame, Time now, Transmitter& out) noexcept {
  std::span<const std::byte> data;
  const Abort refused = dictionary_->read(key_, now, data);
  if (refused != Abort::none) return abort(refused, now, out);
  if (data.size() <= frame.data[5]) return start_upload(now, out);
  if (frame.data[4] == 0 || frame.data[4] > 127) return abort(Abort::block_size, now, out);
  const bool crc = (frame.data[0] & 0x04) != 0 && !faults_->no_crc;
  buffer_.assign(data.begin(), data.end());
  sender_.begin(crc, frame.data[4], buffer_.size());
  state_ = State::block_offered;
  deadline_ = now + session_limit;
  const unsigned command = 0xC0u | (crc ? 4u : 0u) | (faults_->no_size ? 0u : 2u);
  answer(static_cast<std::uint8_t>(command), little_endian(announced(buffer_.size())), now, out);
}

void SdoServer::on_block_upload(const Frame& frame, Time now, Transmitter& out) noexcept {
  const unsigned what = frame.data[0] & 3u;
  if (state_ == State::block_ended && what == 1) return reset();
  deadline_ = now + session_limit;
  if (state_ == State::block_offered && what == 3) {
    state_ = State::block_sending;
    next_segment_ = now + latency_;
    return;
  }
  if (state_ != State::block_sending || what != 2) return abort(Abort::command, now, out);
  if (!sender_.on_confirm(frame.data)) return abort(sender_.code(), now, out);
  if (!sender_.all_confirmed()) {
    next_segment_ = now + latency_;
    return;
  }
  state_ = State::block_ended;
  next_segment_ = never;
  reply(sender_.end(buffer_, *faults_), now, out);
}

void SdoServer::send_block_segment(Time now, Transmitter& out) noexcept {
  SdoBytes segment{};
  if (!sender_.next(buffer_, *faults_, segment)) {
    next_segment_ = never;
    return;
  }
  out.send({.id = answer_id_, .length = 8, .data = segment}, now);
  next_segment_ = now + segment_time_;
  deadline_ = now + session_limit;
}

void SdoServer::on_time(Time now, Transmitter& out) noexcept {
  if (now >= next_segment_) return send_block_segment(now, out);
  if (now < deadline_) return;
  if (state_ == State::block_receiving) return block_received(receiver_.on_silence(), now, out);
  abort(Abort::timeout, now, out);
}

void SdoServer::reply(const SdoBytes& bytes, Time now, Transmitter& out) noexcept {
  send({.id = answer_id_, .length = 8, .data = bytes}, now, out);
}

void SdoServer::answer(std::uint8_t command, std::span<const std::byte> data, Time now,
                       Transmitter& out) noexcept {
  Frame frame =
      make_frame(answer_id_, {command, static_cast<std::uint8_t>(key_.index & 0xFF),
                              static_cast<std::uint8_t>(key_.index >> 8), key_.sub, 0, 0, 0, 0});
  for (std::size_t i = 0; i < std::min<std::size_t>(data.size(), 4); ++i) {
    frame.data[4 + i] = std::to_integer<std::uint8_t>(data[i]);
  }
  send(frame, now, out);
}

/// Sends a confirmation. Only the answer to an initiate names the object. CiA 301, 7.2.4.3.
void SdoServer::confirm(std::uint8_t command, Time now, Transmitter& out) noexcept {
  if (command == 0x60) return answer(command, {}, now, out);
  send(make_frame(answer_id_, {command, 0, 0, 0, 0, 0, 0, 0}), now, out);
}

void SdoServer::abort(Abort code, Time now, Transmitter& out) noexcept {
  reset();
  if (dictionary_->is_mute(key_)) return;
  answer(0x80, little_endian(static_cast<std::uint32_t>(code)), now, out);
}

void SdoServer::send(Frame frame, Time now, Transmitter& out) noexcept {
  out.send(frame, now + latency_);
}

}  // namespace takt::sim
