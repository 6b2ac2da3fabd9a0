#include "master/core/sdo/sdo_client.hpp"

#include <cassert>

#include "eds_parser/table/waits.hpp"
#include "master/wire/sdo_abort.hpp"

// This file contains the begin and the end of a transfer, its frames to the server, and its
// time-out.

namespace takt {

namespace {

/// Up to this number of bytes, the server may answer without a block transfer, because four
/// segments take no longer.
constexpr std::uint8_t switch_threshold = 28;

}  // namespace

void SdoClient::upload(ObjectKey object, std::span<std::byte> buffer, Time timeout,
                       SdoMode mode) noexcept {
  begin(object, timeout);
  if (mode == SdoMode::block && may_use_block()) {
    transfer_.emplace<SdoBlockUpload>().begin({.channel = channel_,
                                               .object = object,
                                               .segments = segments_,
                                               .threshold = switch_threshold},
                                              buffer);
  } else {
    transfer_.emplace<SdoUpload>(channel_, object, buffer);
  }
}

void SdoClient::download(ObjectKey object, std::span<const std::byte> value,
                         Time timeout) noexcept {
  begin(object, timeout);
  if (value.size() >= block_from && may_use_block()) {
    transfer_.emplace<SdoBlockDownload>().begin(channel_, object, value);
  } else {
    transfer_.emplace<SdoDownload>(channel_, object, value);
  }
}

void SdoClient::begin(ObjectKey object, Time timeout) noexcept {
  assert(idle());
  if (object_ != object) answered_.reset();
  if (begun()) previous_.last_answer = previous_.aborted_by_master() ? Frame{} : trace_.received;
  state_ = State::running;
  object_ = object;
  timeout_ = timeout;
  deadline_ = never;
  trace_ = {};
}

/// Transfers the value of the present block transfer from the beginning, without blocks.
void SdoClient::begin_without_block(State state) noexcept {
  state_ = state;
  deadline_ = never;
  if (const auto* const upload = block_upload()) {
    transfer_ = SdoUpload{channel_, object_, upload->buffer()};
  } else if (const auto* const download = block_download()) {
    transfer_ = SdoDownload{channel_, object_, download->value()};
  }
}

void SdoClient::cancel() noexcept {
  if (state_ == State::idle || state_ == State::settling) return;
  abort(SdoFault::cancelled, abort_code::general_error);
  if (!begun()) closing_.reset();
}

void SdoClient::drop() noexcept {
  state_ = State::idle;
  deadline_ = never;
  block_support_ = BlockSupport::assumed;
  previous_.server_was_reset();
  closing_.reset();
  result_.reset();
  no_block_.reset();
  late_.forget_requests();
}

void SdoClient::finish(const SdoResult& result, PreviousTransfer::End end) noexcept {
  state_ = State::idle;
  deadline_ = never;
  previous_.end = end;
  result_ = result;
}

void SdoClient::abort(SdoFault fault, std::uint32_t code) noexcept {
  const bool in_block = state_ == State::running && block_upload() != nullptr;
  closing_ = {.frame = sdo_abort(channel_.request, object_, code),
              .answer = awaits_sub_block() ? Answer::after_stream : Answer::none};
  finish({.fault = fault, .abort_code = code, .size = progress()},
         PreviousTransfer::end_by_abort(fault, in_block));
  previous_.object = object_;
}

std::optional<SdoClient::NoBlock> SdoClient::take_no_block() noexcept {
  return std::exchange(no_block_, std::nullopt);
}

std::size_t SdoClient::progress() const noexcept {
  return std::visit([](const auto& transfer) { return transfer.moved(); }, transfer_);
}

std::size_t SdoClient::announced() const noexcept {
  if (const auto* const upload = block_upload()) return upload->announced().value_or(0);
  if (const auto* const upload = plain_upload()) return upload->announced().value_or(0);
  return 0;
}

std::optional<Frame> SdoClient::next_frame() const noexcept {
  if (closing_) return closing_->frame;
  if (!runs()) return std::nullopt;
  return std::visit([](const auto& transfer) { return transfer.to_send(); }, transfer_);
}

Answer SdoClient::answer_to_next() const noexcept {
  if (closing_) return closing_->answer;
  if (block_upload() != nullptr && block_upload()->asks_for_sub_block()) return Answer::stream;
  const bool burst = block_download() != nullptr && !block_download()->answered();
  return burst ? Answer::none : Answer::by_server;
}

Time SdoClient::deadline() const noexcept { return result_ || next_frame() ? at_once : deadline_; }

void SdoClient::on_time(Time now, Outbox& out) noexcept {
  if (state_ != State::idle && now >= deadline_ && !next_frame()) on_silence();
  const auto frame = next_frame();
  if (frame && out.push(*frame, answer_to_next())) frame_sent(*frame, now);
}

void SdoClient::frame_sent(const Frame& frame, Time now) noexcept {
  if (closing_) {
    closing_.reset();
    if (state_ == State::withdrawing) begin_without_block(State::without_block);
    return;
  }
  std::visit([](auto& transfer) { transfer.sent(); }, transfer_);
  trace_.sent = frame;
  asked_ = {.at = now};
  deadline_ = now + answer_timeout();
}

Time SdoClient::answer_timeout() const noexcept {
  const bool may_ask_again = block_upload() != nullptr && block_upload()->in_sub_block();
  return may_ask_again ? waits::block_silence(timeout_) : timeout_;
}

void SdoClient::on_silence() noexcept {
  if (state_ == State::settling) return finish(settled_, PreviousTransfer::End::regular);
  if (auto* const upload = std::get_if<SdoBlockUpload>(&transfer_)) {
    if (upload->confirm_after_silence()) return;
  }
  if (unanswered_block()) {
    closing_ = {.frame = sdo_abort(channel_.request, object_, abort_code::timeout)};
    state_ = State::withdrawing;
    return;
  }
  // No answer has come except the ignored one, so the ignored one was the answer to this request.
  if (asked_.misanswered) return abort(SdoFault::aborted_by_master, abort_code::command_unknown);
  give_up_late();
}

/// Gives up a transfer because the server does not answer within the time-out.
void SdoClient::give_up_late() noexcept {
  if (const auto asked = question()) late_.timed_out(*asked, asked_.at);
  abort(SdoFault::timeout, abort_code::timeout);
}

}  // namespace takt
