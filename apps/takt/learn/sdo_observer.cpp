#include "apps/takt/learn/sdo_observer.hpp"

#include <utility>

#include "master/wire/sdo_codec.hpp"

namespace takt::learn {
namespace {

constexpr std::uint8_t abort_command = 0x80;

}  // namespace

void SdoObserver::begin(SdoTransfer::Kind kind, ObjectKey object) noexcept {
  if (state_ != State::idle) ++cut_off_;
  block_.stop();
  transfer_ = {.kind = kind, .object = object};
  state_ = State::asked;
}

void SdoObserver::keep(std::span<const std::uint8_t> bytes) {
  if (transfer_.value.size() + bytes.size() > most_kept) {
    transfer_.extent = SdoTransfer::Extent::too_long;
    return;
  }
  transfer_.value.insert(transfer_.value.end(), bytes.begin(), bytes.end());
}

std::optional<SdoTransfer> SdoObserver::finish() {
  state_ = State::idle;
  return std::exchange(transfer_, {});
}

std::optional<SdoTransfer> SdoObserver::aborted(const Frame& frame) {
  block_.stop();
  if (state_ == State::idle) {
    ++strays_;
    return {};
  }
  transfer_.abort_code = sdo_abort_code(frame);
  return finish();
}

void SdoObserver::download(const Frame& frame) {
  const SdoInitiate initiate = decode_initiate(frame);
  begin(SdoTransfer::Kind::write, initiate.object);
  if (initiate.expedited) {
    keep(initiate.payload());
    state_ = State::last_sent;
  } else {
    state_ = State::announced;
  }
}

void SdoObserver::sent_segment(const Frame& frame) {
  if (state_ != State::segments || transfer_.kind != SdoTransfer::Kind::write) {
    ++strays_;
    return;
  }
  const SdoSegment part = decode_segment(frame);
  keep(part.payload());
  if (part.last) state_ = State::last_sent;
}

/// Takes a frame that begins a block transfer or belongs to the running one. Returns false for all
/// other frames.
bool SdoObserver::block_request(const Frame& frame) {
  const SdoRequest command = sdo_request(frame);
  if (block_.running()) {
    const bool part = block_.uploads()
                          ? command == SdoRequest::block_upload && !is_block_accept(frame)
                          : block_.in_segments() || is_block_end(frame);
    if (part) {
      block_.uploads() ? block_.from_sink(frame, {}) : block_.from_source(frame, {});
      return true;
    }
  }
  const bool download = command == SdoRequest::block_download && is_block_initiate(frame);
  const bool upload = command == SdoRequest::block_upload && is_block_accept(frame);
  if (!download && !upload) return false;
  begin(upload ? SdoTransfer::Kind::read : SdoTransfer::Kind::write, sdo_object(frame));
  block_.begin(sdo_object(frame),
               upload ? BlockText::Direction::upload : BlockText::Direction::download);
  upload ? block_.from_sink(frame, {}) : block_.from_source(frame, {});
  return true;
}

/// Ends a block transfer after its end was confirmed.
std::optional<SdoTransfer> SdoObserver::block_end() {
  if (block_.running()) return {};
  using enum SdoTransfer::Extent;
  transfer_.extent = block_.has_value() ? whole : block_.is_too_long() ? too_long : in_parts;
  if (transfer_.extent == whole) transfer_.value = block_.take_value();
  return finish();
}

std::optional<SdoTransfer> SdoObserver::request(const Frame& frame) {
  if (frame.rtr || frame.length != 8) return {};
  if (frame.data[0] == abort_command) return aborted(frame);
  if (block_request(frame)) return block_.uploads() ? block_end() : std::nullopt;
  switch (sdo_request(frame)) {
    case SdoRequest::download_initiate:
      download(frame);
      return {};
    case SdoRequest::upload_initiate:
      begin(SdoTransfer::Kind::read, sdo_object(frame));
      return {};
    case SdoRequest::download_segment:
      sent_segment(frame);
      return {};
    case SdoRequest::upload_segment:
      if (state_ != State::segments) ++strays_;
      return {};
    default:
      ++strays_;
      return {};
  }
}

std::optional<SdoTransfer> SdoObserver::upload(const Frame& frame) {
  const SdoInitiate initiate = decode_initiate(frame);
  if (state_ != State::asked || transfer_.object != initiate.object) {
    ++strays_;
    return {};
  }
  block_.stop();  // a server may answer a block upload request with a segmented upload
  if (!initiate.expedited) {
    state_ = State::segments;
    return {};
  }
  keep(initiate.payload());
  return finish();
}

std::optional<SdoTransfer> SdoObserver::read_segment(const Frame& frame) {
  if (state_ != State::segments || transfer_.kind != SdoTransfer::Kind::read) {
    ++strays_;
    return {};
  }
  const SdoSegment part = decode_segment(frame);
  keep(part.payload());
  return part.last ? finish() : std::nullopt;
}

std::optional<SdoTransfer> SdoObserver::answer(const Frame& frame) {
  if (frame.rtr || frame.length != 8) return {};
  if (frame.data[0] == abort_command) return aborted(frame);
  const SdoAnswer command = sdo_answer(frame);
  if (block_.running()) {
    const bool part = block_.uploads() ? block_.in_segments() || command == SdoAnswer::block_upload
                                       : command == SdoAnswer::block_download;
    if (part) {
      block_.uploads() ? block_.from_source(frame, {}) : block_.from_sink(frame, {});
      return block_.uploads() ? std::nullopt : block_end();
    }
  }
  switch (command) {
    case SdoAnswer::upload_initiate:
      return upload(frame);
    case SdoAnswer::upload_segment:
      return read_segment(frame);
    case SdoAnswer::download_initiate:
      if (transfer_.object == sdo_object(frame)) {
        if (state_ == State::last_sent) return finish();
        if (state_ == State::announced) {
          state_ = State::segments;
          return {};
        }
      }
      break;
    case SdoAnswer::download_segment:
      if (state_ == State::last_sent) return finish();
      if (state_ == State::segments) return {};
      break;
    default:
      break;
  }
  ++strays_;
  return {};
}

}  // namespace takt::learn
