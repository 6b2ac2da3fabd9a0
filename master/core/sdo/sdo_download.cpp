#include "master/core/sdo/sdo_download.hpp"

namespace takt {

using Kind = SdoStep::Kind;

SdoQuestion SdoDownload::question() const noexcept {
  return {.answer = initiates() ? SdoAnswer::download_initiate : SdoAnswer::download_segment,
          .toggle = toggle_,
          .object = object_};
}

SdoStep SdoDownload::on_answer(const Frame& /*confirmation*/) noexcept {
  switch (state_) {
    case State::initiate:
      if (!value_.empty() && value_.size() <= 4) {
        moved_ = value_.size();
        return {Kind::done};
      }
      break;
    case State::segments:
      toggle_ = !toggle_;
      break;
    case State::last_segment:
      return {Kind::done};
  }
  send_segment();
  return {Kind::goes_on};
}

void SdoDownload::send_segment() noexcept {
  const SdoSegment part = sdo_segment(value_.subspan(moved_), toggle_);
  moved_ += part.size;
  state_ = part.last ? State::last_segment : State::segments;
  to_send_ = download_segment_request(channel_.request, part);
}

}  // namespace takt
