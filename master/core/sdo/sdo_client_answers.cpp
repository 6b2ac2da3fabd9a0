#include <algorithm>
#include <iterator>

#include "eds_parser/table/waits.hpp"
#include "master/core/sdo/sdo_client.hpp"
#include "master/wire/sdo_abort.hpp"

// This file evaluates the frames of the server.

namespace takt {

namespace {

/// Returns true if the abort code says that the server does not support block transfer at all,
/// rather than that it refuses this one.
bool refuses_block(std::uint32_t code) noexcept {
  using namespace abort_code;
  constexpr std::uint32_t codes[] = {
      command_unknown, block_size,           sequence,     crc, out_of_memory, access_unsupported,
      length_mismatch, resource_unavailable, general_error};
  return std::ranges::find(codes, code) != std::end(codes);
}

}  // namespace

void SdoClient::on_frame(const Frame& frame, Time now) noexcept {
  heard_at_ = now;
  const bool late = note_late(frame, now);
  if (state_ == State::idle || state_ == State::settling) return;
  // While a request waits to be sent, every answer belongs to an earlier one.
  const bool block = streams();
  if (closing_ || (!block && next_frame())) return;
  if (!is_whole(frame)) {
    trace_.received = frame;
    trace_.empty_answer = trace_.empty_answer || frame.length == 0;
    return;
  }
  if (block) return on_block(frame, now);
  on_plain_answer(frame, now, late);
}

/// Returns true if the frame answers a request that has timed out, and not the present one.
bool SdoClient::note_late(const Frame& frame, Time now) noexcept {
  // Segments of a block carry a number where other frames have their command specifier.
  const bool numbered = state_ == State::running && block_upload() != nullptr;
  if (numbered || frame.length < sdo_answer_bytes(frame)) return false;
  const auto asked = question();
  const bool fits = asked && !next_frame() && asked->is_answered_by(frame);
  return late_.take(frame, now,
                    fits ? LateAnswers::Fits::request_under_way : LateAnswers::Fits::only_earlier);
}

/// Returns the request that was sent last, or std::nullopt in a block transfer.
std::optional<SdoQuestion> SdoClient::question() const noexcept {
  if (!runs()) return std::nullopt;
  if (const auto* const upload = plain_upload()) return upload->question();
  if (const auto* const download = plain_download()) return download->question();
  return std::nullopt;
}

/// Returns true if the frame is complete. In a block, only the last segment may be short.
bool SdoClient::is_whole(const Frame& frame) const noexcept {
  const bool segment =
      block_upload() != nullptr && block_upload()->in_sub_block() && frame.data[0] != 0x80;
  if (segment) return frame.length == 8 || (frame.length > 1 && (frame.data[0] & 0x80) != 0);
  return frame.length >= sdo_answer_bytes(frame);
}

/// Returns true if the first request of the transfer is not answered yet.
bool SdoClient::initiates() const noexcept {
  return std::visit([](const auto& transfer) { return transfer.initiates(); }, transfer_);
}

void SdoClient::on_plain_answer(const Frame& frame, Time now, bool late) noexcept {
  const bool initiates = initiates_plain();
  if (previous_.may_send_segments() && initiates && sdo_object(frame) != object_) return;
  switch (sdo_answer(frame)) {
    case SdoAnswer::abort:
      return on_abort(frame, now);
    case SdoAnswer::block_download:
    case SdoAnswer::block_upload:
      // CAN sometimes repeats a frame. A repeated end of a block transfer does not answer a new
      // transfer.
      if (state_ == State::without_block) return;
      if (initiates && (is_block_end(frame) || is_block_end_confirm(frame))) return;
      [[fallthrough]];
    case SdoAnswer::reserved:
      trace_.received = frame;
      return abort(SdoFault::aborted_by_master, abort_code::command_unknown);
    case SdoAnswer::upload_initiate:
    case SdoAnswer::upload_segment:
    case SdoAnswer::download_initiate:
    case SdoAnswer::download_segment:
      break;
  }
  switch (question()->compare(frame)) {
    case SdoQuestion::Fit::other_object:
      return on_other_object(frame, late);
    case SdoQuestion::Fit::other_command:
      return on_wrong_answer(frame, late);
    case SdoQuestion::Fit::other_toggle:
      trace_.received = frame;
      // A late segment of an earlier try has the wrong toggle bit, and the segment before it may
      // have been late too. The server is then too slow, and its bytes can't be used.
      if (late) return give_up_late();
      return abort(SdoFault::aborted_by_master, abort_code::toggle_not_alternated);
    case SdoQuestion::Fit::fits:
      break;
  }
  heard(frame);
  if (auto* const upload = std::get_if<SdoUpload>(&transfer_)) {
    return on_step(upload->on_answer(frame), frame, now);
  }
  on_step(std::get_if<SdoDownload>(&transfer_)->on_answer(frame), frame, now);
}

/// Notes an answer for an object that neither this request nor an earlier one has requested.
void SdoClient::on_other_object(const Frame& frame, bool late) noexcept {
  if (late || frame == previous_.last_answer) return;
  trace_.received = frame;
  answered_ = sdo_object(frame);
}

/// Aborts the transfer because of an answer that does not fit the request. An answer that may
/// belong to an earlier request is ignored: the answer to a transfer that was given up may come
/// late, and CAN sometimes repeats a frame. If nothing else comes until the time-out, the transfer
/// is aborted because of that answer.
void SdoClient::on_wrong_answer(const Frame& frame, bool late) noexcept {
  if (late) return;
  const bool earlier =
      previous_.may_be_answered() || frame == previous_.last_answer || frame == trace_.received;
  trace_.received = frame;
  if (!earlier) return abort(SdoFault::aborted_by_master, abort_code::command_unknown);
  asked_.misanswered = true;
}

void SdoClient::on_block(const Frame& frame, Time now) noexcept {
  if (!begun()) return;                                    // nothing was requested yet
  if (frame.data[0] == 0x80) return on_abort(frame, now);  // a segment never has the number 0
  auto* const upload = std::get_if<SdoBlockUpload>(&transfer_);
  const SdoStep step = upload != nullptr
                           ? upload->on_frame(frame)
                           : std::get_if<SdoBlockDownload>(&transfer_)->on_frame(frame);
  if (step.kind == SdoStep::Kind::stranger) return;
  trace_.received = frame;
  on_step(step, frame, now);
}

void SdoClient::on_step(const SdoStep& step, const Frame& frame, Time now) noexcept {
  switch (step.kind) {
    case SdoStep::Kind::stranger:
    case SdoStep::Kind::goes_on:
      deadline_ = now + answer_timeout();
      return;
    case SdoStep::Kind::plain: {
      begin_without_block(State::running);
      auto& upload = *std::get_if<SdoUpload>(&transfer_);
      upload.sent();  // this frame is already the answer
      return on_step(upload.on_answer(frame), frame, now);
    }
    case SdoStep::Kind::abort:
      return abort(step.fault, step.abort_code);
    case SdoStep::Kind::done:
      return on_done();
  }
}

void SdoClient::on_done() noexcept {
  if (block_upload() != nullptr) closing_ = {.frame = *block_upload()->to_send()};
  // Some devices announce the size of the buffer of a string and send only the string.
  finish({.size = progress(), .shortened = progress() < announced()},
         is_block() ? PreviousTransfer::End::block : PreviousTransfer::End::regular);
}

void SdoClient::on_abort(const Frame& frame, Time now) noexcept {
  if (is_abort_of_previous(frame)) return;
  const std::uint32_t code = sdo_abort_code(frame);
  // This abort is the late refusal of the block transfer, and not of the request that was sent
  // after it.
  if (state_ == State::without_block && code == abort_code::command_unknown) {
    state_ = State::running;
    return learn_no_block(code);
  }
  heard(frame);
  if (fall_back(code)) return;
  settled_ = {.fault = SdoFault::aborted_by_device, .abort_code = code, .size = progress()};
  const bool burst = block_download() != nullptr && !block_download()->initiates();
  if (!burst) return finish(settled_, PreviousTransfer::End::regular);
  state_ = State::settling;
  deadline_ = now + waits::sdo_settle;
}

/// Servers put arbitrary objects into an abort, so all aborts are accepted, with two exceptions:
/// the late abort of a previous transfer that the master has aborted, and the refusal of the end of
/// a block transfer that has reached the server twice. The second one comes only once.
bool SdoClient::is_abort_of_previous(const Frame& frame) noexcept {
  const ObjectKey object = sdo_object(frame);
  if (object == object_) return false;
  if (previous_.aborted_by_master()) return object == previous_.object;
  const bool of_end = previous_.end == PreviousTransfer::End::block &&
                      (initiates_plain() || unanswered_block()) &&
                      sdo_abort_code(frame) == abort_code::command_unknown;
  if (of_end) previous_.end = PreviousTransfer::End::regular;
  return of_end;
}

/// Transfers the value by segments, if the server has refused block transfer before any data were
/// transferred. Returns false if this is not the case.
bool SdoClient::fall_back(std::uint32_t code) noexcept {
  if (!unanswered_block() || !refuses_block(code)) return false;
  if (code == abort_code::command_unknown) learn_no_block(code);
  begin_without_block(State::running);
  return true;
}

void SdoClient::learn_no_block(std::uint32_t code) noexcept {
  if (block_support_ == BlockSupport::assumed) no_block_ = {.object = object_, .abort_code = code};
  block_support_ = BlockSupport::lacking;
}

/// Notes an answer. If a server was silent only for the block transfer, it supports no block
/// transfer.
void SdoClient::heard(const Frame& frame) noexcept {
  trace_.received = frame;
  if (state_ != State::without_block) return;
  state_ = State::running;
  learn_no_block(0);
}

}  // namespace takt
