#include "master/core/sdo/sdo_client.hpp"

#include <cassert>
#include <utility>

#include "eds_parser/table/waits.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt {

namespace {

/// Objects of up to this number of bytes may come without block transfer, because four segments are
/// as quick.
constexpr std::uint8_t switch_threshold = 28;

/// The abort code says that the server does not support block transfer at all, rather than that it
/// refuses this one.
bool refuses_block(std::uint32_t code) noexcept {
  switch (code) {
    case abort_code::command_unknown:
    case abort_code::block_size:
    case abort_code::sequence:
    case abort_code::crc:
    case abort_code::out_of_memory:
    case abort_code::access_unsupported:
    case abort_code::length_mismatch:
    case abort_code::resource_unavailable:
    case abort_code::general_error:
      return true;
    default:
      return false;
  }
}

}  // namespace

void SdoClient::upload(ObjectKey object, std::span<std::byte> buffer, Time timeout,
                       SdoMode mode) noexcept {
  buffer_ = buffer;
  uploads_ = true;
  const bool block = mode == SdoMode::block && blocks();
  begin(block ? State::block_upload : State::upload_initiate, object, timeout);
}

void SdoClient::download(ObjectKey object, std::span<const std::byte> value,
                         Time timeout) noexcept {
  value_ = value;
  uploads_ = false;
  const bool block = value.size() >= block_from && blocks();
  begin(block ? State::block_download : State::download_initiate, object, timeout);
}

void SdoClient::begin(State state, ObjectKey object, Time timeout) noexcept {
  assert(idle());
  if (object_ != object) answered_.reset();
  if (begun()) previous_answer_ = given_up_ ? Frame{} : last_received_;
  object_ = object;
  timeout_ = timeout;
  last_sent_ = {};
  last_received_ = {};
  done_ = 0;
  announced_.reset();
  block_unheard_ = false;
  empty_answer_ = false;
  left_stream_ = false;
  if (state != State::block_upload && state != State::block_download) return begin_plain(state);
  state_ = state;
  deadline_ = never;
  if (state == State::block_upload) {
    block_upload_.begin({.channel = channel_,
                         .object = object,
                         .segments = segments_,
                         .threshold = switch_threshold},
                        buffer_);
  } else {
    block_download_.begin(channel_, object, value_);
  }
}

void SdoClient::begin_plain(State state) noexcept {
  state_ = state;
  deadline_ = never;
  toggle_ = false;
  last_segment_sent_ = false;
  done_ = 0;
  announced_.reset();
  to_send_ = state == State::upload_initiate
                 ? upload_request(channel_.request, object_)
                 : download_request(channel_.request, sdo_initiate(object_, value_));
}

void SdoClient::cancel() noexcept {
  if (state_ == State::idle || state_ == State::settling) return;
  abort(SdoFault::cancelled, abort_code::general_error);
  if (!begun()) to_send_.reset();
}

void SdoClient::drop() noexcept {
  state_ = State::idle;
  deadline_ = never;
  block_refused_ = false;
  block_ended_ = false;
  late_segments_ = false;
  left_stream_ = false;
  to_send_.reset();
  result_.reset();
  no_block_.reset();
  late_.forget_requests();
}

std::optional<SdoResult> SdoClient::take_result() noexcept {
  return std::exchange(result_, std::nullopt);
}

std::optional<SdoClient::NoBlock> SdoClient::take_no_block() noexcept {
  return std::exchange(no_block_, std::nullopt);
}

std::size_t SdoClient::progress() const noexcept {
  if (state_ == State::block_upload) return block_upload_.received();
  if (state_ == State::block_download) return block_download_.confirmed();
  return done_;
}

std::size_t SdoClient::announced() const noexcept { return announced_.value_or(0); }

std::optional<Frame> SdoClient::next_frame() const noexcept {
  if (to_send_) return to_send_;
  if (state_ == State::block_upload) return block_upload_.to_send();
  if (state_ == State::block_download) return block_download_.to_send();
  return std::nullopt;
}

Answer SdoClient::answer_to_next() const noexcept {
  // The frame is an abort, or the end of a block upload.
  if (state_ == State::idle) return left_stream_ ? Answer::after_stream : Answer::none;
  if (state_ == State::falling_back) return Answer::none;
  if (state_ == State::block_upload && block_upload_.asks_for_sub_block()) return Answer::stream;
  const bool burst = state_ == State::block_download && !block_download_.answered();
  return burst ? Answer::none : Answer::by_server;
}

Time SdoClient::deadline() const noexcept { return result_ || next_frame() ? at_once : deadline_; }

void SdoClient::on_time(Time now, Outbox& out) noexcept {
  if (state_ != State::idle && now >= deadline_ && !next_frame()) on_silence();
  const auto frame = next_frame();
  if (frame && out.push(*frame, answer_to_next())) frame_sent(*frame, now);
}

void SdoClient::frame_sent(const Frame& frame, Time now) noexcept {
  const bool from_block = !to_send_;
  to_send_.reset();
  if (from_block && state_ == State::block_upload) block_upload_.sent();
  if (from_block && state_ == State::block_download) block_download_.sent();
  if (state_ == State::idle) return;
  if (state_ == State::falling_back) {
    block_unheard_ = true;
    return begin_plain(uploads_ ? State::upload_initiate : State::download_initiate);
  }
  last_sent_ = frame;
  asked_at_ = now;
  unfit_ = false;
  deadline_ = now + patience();
}

/// The request that was sent last in a transfer without blocks.
SdoQuestion SdoClient::question() const noexcept {
  SdoQuestion out{.toggle = toggle_, .object = object_};
  if (in_initiate()) {
    out.answer = uploads_ ? SdoAnswer::upload_initiate : SdoAnswer::download_initiate;
  } else {
    out.answer = uploads_ ? SdoAnswer::upload_segment : SdoAnswer::download_segment;
  }
  return out;
}

/// Looks whether the frame answers a request that has timed out.
void SdoClient::note_late(const Frame& frame, Time now) noexcept {
  late_now_ = false;
  // Segments of a block carry a number where other frames have their command specifier.
  if (state_ == State::block_upload || frame.length < sdo_answer_bytes(frame)) return;
  const bool fits = asks_plainly() && !to_send_ && question().is_answered_by(frame);
  late_now_ = late_.take(
      frame, now, fits ? LateAnswers::Fits::request_under_way : LateAnswers::Fits::only_earlier);
}

/// Gives up a transfer because the server does not answer within the time-out.
void SdoClient::give_up_late() noexcept {
  if (asks_plainly()) late_.timed_out(question(), asked_at_);
  abort(SdoFault::timeout, abort_code::timeout);
}

Time SdoClient::patience() const noexcept {
  const bool may_ask_again = state_ == State::block_upload && block_upload_.in_sub_block();
  return may_ask_again ? waits::block_silence(timeout_) : timeout_;
}

void SdoClient::on_silence() noexcept {
  if (state_ == State::settling) return finish(settled_);
  if (state_ == State::block_upload && block_upload_.confirm_after_silence()) return;
  if (unanswered_block()) {
    to_send_ = sdo_abort(channel_.request, object_, abort_code::timeout);
    state_ = State::falling_back;
    return;
  }
  // Nothing came but the answer that was ignored, so that answer was meant.
  if (unfit_) return abort(SdoFault::aborted_by_master, abort_code::command_unknown);
  give_up_late();
}

void SdoClient::finish(SdoResult result) noexcept {
  state_ = State::idle;
  deadline_ = never;
  given_up_.reset();
  late_possible_ = false;
  block_ended_ = false;
  late_segments_ = false;
  result_ = result;
}

void SdoClient::abort(SdoFault fault, std::uint32_t code) noexcept {
  const bool segments = state_ == State::block_upload;
  left_stream_ = awaits_sub_block();
  to_send_ = sdo_abort(channel_.request, object_, code);
  finish({.fault = fault, .abort_code = code, .size = progress()});
  given_up_ = object_;
  late_possible_ = fault != SdoFault::aborted_by_master;
  late_segments_ = segments;
}

/// The frame has all the bytes that it needs. In a block, only the last segment may be short.
bool SdoClient::is_whole(const Frame& frame) const noexcept {
  const bool segment =
      state_ == State::block_upload && block_upload_.in_sub_block() && frame.data[0] != 0x80;
  if (segment) return frame.length == 8 || (frame.length > 1 && (frame.data[0] & 0x80) != 0);
  return frame.length >= sdo_answer_bytes(frame);
}

/// CAN sometimes repeats a frame. A repeated end of a block transfer does not answer a new
/// transfer.
bool SdoClient::is_of_earlier_block(const Frame& frame) const noexcept {
  const bool end = is_block_end(frame) || is_block_end_confirm(frame);
  return in_initiate() && (block_unheard_ || end);
}

void SdoClient::on_frame(const Frame& frame, Time now) noexcept {
  heard_at_ = now;
  note_late(frame, now);
  // While a request waits to be sent, every answer belongs to an earlier one.
  if (state_ == State::idle || state_ == State::settling) return;
  if (to_send_) return;
  if (!is_whole(frame)) {
    last_received_ = frame;  // for reports
    empty_answer_ = empty_answer_ || frame.length == 0;
    return;
  }
  if (state_ == State::block_upload || state_ == State::block_download) return on_block(frame, now);
  if (late_segments_ && in_initiate() && sdo_object(frame) != object_) return;
  switch (sdo_answer(frame)) {
    case SdoAnswer::abort:
      return on_abort(frame, now);
    case SdoAnswer::upload_initiate:
      return on_upload_initiate(frame);
    case SdoAnswer::upload_segment:
      return on_upload_segment(frame);
    case SdoAnswer::download_initiate:
      return on_download_confirmed(frame);
    case SdoAnswer::download_segment:
      return on_download_segment_confirmed(frame);
    case SdoAnswer::block_download:
    case SdoAnswer::block_upload:
      if (is_of_earlier_block(frame)) return;
      [[fallthrough]];
    case SdoAnswer::reserved:
      last_received_ = frame;
      return abort(SdoFault::aborted_by_master, abort_code::command_unknown);
  }
}

void SdoClient::on_abort(const Frame& frame, Time now) noexcept {
  // Servers put arbitrary objects into an abort, so all aborts are accepted, except for the late
  // abort of a transfer that was given up before this one.
  const ObjectKey object = sdo_object(frame);
  if (given_up_ == object && object != object_) return;
  // The server has received the end of the previous block transfer twice, and refuses the second
  // one as an end without a transfer.
  const bool of_end = block_ended_ && (in_initiate() || unanswered_block()) && object != object_ &&
                      sdo_abort_code(frame) == abort_code::command_unknown;
  if (of_end) {
    block_ended_ = false;
    return;
  }
  // The server refuses the block transfer late; it does not refuse the request that was sent since.
  if (block_unheard_ && sdo_abort_code(frame) == abort_code::command_unknown) {
    block_unheard_ = false;
    return learn_no_block(abort_code::command_unknown);
  }
  heard(frame);
  if (fall_back(sdo_abort_code(frame))) return;
  settled_ = {.fault = SdoFault::aborted_by_device,
              .abort_code = sdo_abort_code(frame),
              .size = progress()};
  const bool burst = state_ == State::block_download && block_download_.accepted();
  if (!burst) return finish(settled_);
  state_ = State::settling;
  deadline_ = now + waits::sdo_settle;
}

/// No data were transferred yet.
bool SdoClient::unanswered_block() const noexcept {
  return (state_ == State::block_upload && !block_upload_.accepted()) ||
         (state_ == State::block_download && !block_download_.accepted());
}

/// The server refuses block transfer before any data were transferred, so the client transfers the
/// value by segments.
bool SdoClient::fall_back(std::uint32_t code) noexcept {
  if (!unanswered_block() || !refuses_block(code)) return false;
  if (code == abort_code::command_unknown) learn_no_block(code);
  begin_plain(uploads_ ? State::upload_initiate : State::download_initiate);
  return true;
}

void SdoClient::learn_no_block(std::uint32_t code) noexcept {
  if (!std::exchange(block_refused_, true)) no_block_ = {.object = object_, .abort_code = code};
}

/// Notes an answer. If a server was silent only for the block transfer, it supports no block
/// transfer.
void SdoClient::heard(const Frame& frame) noexcept {
  last_received_ = frame;
  if (std::exchange(block_unheard_, false)) learn_no_block(0);
}

void SdoClient::on_block(const Frame& frame, Time now) noexcept {
  if (last_sent_.length == 0) return;                      // nothing was requested yet
  if (frame.data[0] == 0x80) return on_abort(frame, now);  // a segment never has the number 0
  const bool upload = state_ == State::block_upload;
  const SdoBlockStep step =
      upload ? block_upload_.on_frame(frame) : block_download_.on_frame(frame);
  if (upload) announced_ = block_upload_.announced();
  if (step.kind == SdoBlockStep::Kind::stranger) return;
  last_received_ = frame;
  switch (step.kind) {
    case SdoBlockStep::Kind::stranger:
    case SdoBlockStep::Kind::goes_on:
      deadline_ = now + patience();
      return;
    case SdoBlockStep::Kind::plain:
      begin_plain(State::upload_initiate);
      to_send_.reset();  // this frame is already the answer
      return on_upload_initiate(frame);
    case SdoBlockStep::Kind::abort:
      return abort(step.fault, step.abort_code);
    case SdoBlockStep::Kind::done:
      break;
  }
  if (upload) {
    to_send_ = block_upload_.to_send();
    const std::size_t size = block_upload_.received();
    finish({.size = size, .shortened = size < block_upload_.announced().value_or(0)});
  } else {
    finish({.size = value_.size()});
  }
  block_ended_ = true;
}

}  // namespace takt
