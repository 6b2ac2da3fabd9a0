#include "master/trace/sdo_follower.hpp"

#include <utility>

#include "master/wire/sdo_codec.hpp"

namespace takt {
namespace {

using Kind = SeenTransfer::Kind;
using Extent = SeenTransfer::Extent;

/// Returns true if the frame is an abort. A segment of a block transfer never has the number 0.
bool is_abort(const Frame& frame) noexcept { return frame.data[0] == 0x80; }

}  // namespace

std::optional<SeenTransfer> SdoFollower::stray() noexcept {
  ++strays_;
  newest_.stray = true;
  return {};
}

void SdoFollower::begin(Kind kind, ObjectKey object) noexcept {
  if (state_ != State::idle) ++cut_off_;
  transfer_ = {.kind = kind, .object = object};
  asked_toggle_.reset();
  answered_toggle_.reset();
  state_ = State::asked;
}

std::optional<SeenTransfer> SdoFollower::finish() {
  state_ = State::idle;
  return transfer_;
}

void SdoFollower::keep(std::span<const std::uint8_t> bytes) {
  transfer_.length += bytes.size();
  if (transfer_.length > most_kept) {
    transfer_.extent = Extent::too_long;
    return;
  }
  transfer_.value.insert(transfer_.value.end(), bytes.begin(), bytes.end());
}

std::optional<SeenTransfer> SdoFollower::abort(const Frame& frame) {
  block_.stop();
  if (state_ == State::idle) return stray();
  transfer_.abort_code = sdo_abort_code(frame);
  return finish();
}

std::optional<SeenTransfer> SdoFollower::request(const Frame& frame) {
  newest_ = {};
  if (frame.rtr || frame.length != 8) return {};
  if (is_abort(frame)) return abort(frame);
  const SdoRequest command = sdo_request(frame);
  const bool part = block_.uploads()
                        ? command == SdoRequest::block_upload && !is_block_accept(frame)
                        : (block_.in_segments() && !block_.is_over(frame)) || is_block_end(frame);
  if (block_.running() && part) return take_block_frame(frame, Side::client);
  block_.stop();
  const bool download = command == SdoRequest::block_download && is_block_initiate(frame);
  const bool upload = command == SdoRequest::block_upload && is_block_accept(frame);
  if (download || upload) {
    begin(upload ? Kind::read : Kind::write, sdo_object(frame));
    block_.begin(sdo_object(frame),
                 upload ? BlockFollower::Direction::upload : BlockFollower::Direction::download);
    return take_block_frame(frame, Side::client);
  }
  switch (command) {
    case SdoRequest::download_initiate:
      begin_download(frame);
      return {};
    case SdoRequest::upload_initiate:
      begin(Kind::read, sdo_object(frame));
      return {};
    case SdoRequest::download_segment:
      return take_segment(frame, Kind::write);
    case SdoRequest::upload_segment:
      if (!is_in_segments(Kind::read)) return stray();
      check_toggle(asked_toggle_, frame);
      return {};
    default:
      return stray();
  }
}

std::optional<SeenTransfer> SdoFollower::answer(const Frame& frame) {
  newest_ = {};
  if (frame.rtr || frame.length != 8) return {};
  if (is_abort(frame)) return abort(frame);
  const SdoAnswer command = sdo_answer(frame);
  const bool part = block_.uploads() ? block_.in_segments() || command == SdoAnswer::block_upload
                                     : command == SdoAnswer::block_download;
  if (block_.running() && part) return take_block_frame(frame, Side::server);
  block_.stop();  // a server may answer a block upload request with a segmented upload
  switch (command) {
    case SdoAnswer::upload_initiate:
      return begin_upload(frame);
    case SdoAnswer::upload_segment:
      return take_segment(frame, Kind::read);
    case SdoAnswer::download_initiate:
      if (transfer_.object != sdo_object(frame)) return stray();
      if (state_ == State::last_sent) return finish();
      if (!is_in_segments(Kind::write)) return stray();
      state_ = State::segments;
      return {};
    case SdoAnswer::download_segment:
      return confirm_segment(frame);
    default:
      return stray();
  }
}

void SdoFollower::begin_download(const Frame& frame) {
  const SdoInitiate initiate = decode_initiate(frame);
  begin(Kind::write, initiate.object);
  if (initiate.expedited) keep(initiate.payload());
  if (!initiate.expedited) transfer_.announced = initiate.size;
  state_ = initiate.expedited ? State::last_sent : State::announced;
}

/// Begins an upload. If its request is not in the recording, the answer alone names the object.
std::optional<SeenTransfer> SdoFollower::begin_upload(const Frame& frame) {
  const SdoInitiate initiate = decode_initiate(frame);
  if (state_ == State::idle) {
    ++strays_;
    begin(Kind::read, initiate.object);
  }
  if (state_ != State::asked || transfer_.object != initiate.object) return stray();
  if (!initiate.expedited) {
    transfer_.announced = initiate.size;
    state_ = State::segments;
    return {};
  }
  keep(initiate.payload());
  return finish();
}

/// Segments come even if the recording lacks the answer that accepts them.
bool SdoFollower::is_in_segments(Kind kind) const noexcept {
  return transfer_.kind == kind && (state_ == State::segments || state_ == State::announced);
}

/// The toggle bit alternates from frame to frame of the same side, and begins with 0.
void SdoFollower::check_toggle(std::optional<bool>& last, const Frame& frame) noexcept {
  const bool toggle = sdo_toggle(frame);
  newest_.repeats_toggle = std::exchange(last, toggle).value_or(true) == toggle;
}

/// Takes a segment. If its toggle bit repeats, it came twice, or the segment before it was not
/// recorded.
std::optional<SeenTransfer> SdoFollower::take_segment(const Frame& frame, Kind kind) {
  if (!is_in_segments(kind)) return stray();
  check_toggle(kind == Kind::write ? asked_toggle_ : answered_toggle_, frame);
  const SdoSegment part = decode_segment(frame);
  if (newest_.repeats_toggle) {
    transfer_.extent = Extent::in_parts;
  } else {
    keep(part.payload());
  }
  if (!part.last) return {};
  if (kind == Kind::read) return finish();
  state_ = State::last_sent;
  return {};
}

std::optional<SeenTransfer> SdoFollower::confirm_segment(const Frame& frame) {
  const bool last = state_ == State::last_sent;
  if (!last && !is_in_segments(Kind::write)) return stray();
  check_toggle(answered_toggle_, frame);
  return last ? finish() : std::nullopt;
}

/// Takes a frame of a block transfer. The transfer ends when its end was confirmed.
std::optional<SeenTransfer> SdoFollower::take_block_frame(const Frame& frame, Side sender) {
  const bool from_source = block_.uploads() == (sender == Side::server);
  newest_.part = from_source ? block_.from_source(frame) : block_.from_sink(frame);
  if (block_.running()) return {};
  transfer_.extent = block_.has_value()     ? Extent::whole
                     : block_.is_too_long() ? Extent::too_long
                                            : Extent::in_parts;
  if (transfer_.extent == Extent::whole) transfer_.value = block_.take_value();
  return finish();
}

}  // namespace takt
