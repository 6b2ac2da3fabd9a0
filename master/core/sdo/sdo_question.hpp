#pragma once
#include <cstdint>

#include "eds_parser/values/ids.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {

/// The answer that a request of the client expects. It is not used in block transfers.
struct SdoQuestion {
  SdoAnswer answer = SdoAnswer::upload_initiate;  ///< command specifier of the answer
  bool toggle = false;                            ///< toggle bit of the answer; segments only
  ObjectKey object;

  /// The result of the comparison of a frame of the server with the request.
  enum class Fit : std::uint8_t { fits, other_object, other_toggle, other_command };

  /// Compares a frame with the request. Segments carry no object. A frame that begins a transfer of
  /// another object counts as `other_object`, even in the other direction.
  Fit compare(const Frame& frame) const noexcept {
    const SdoAnswer kind = sdo_answer(frame);
    if (initiates(answer) && initiates(kind) && sdo_object(frame) != object) {
      return Fit::other_object;
    }
    if (kind != answer) return Fit::other_command;
    return initiates(kind) || sdo_toggle(frame) == toggle ? Fit::fits : Fit::other_toggle;
  }

  /// Returns true if the frame is an answer to this request. An abort for the object answers every
  /// request.
  bool is_answered_by(const Frame& frame) const noexcept {
    if (sdo_answer(frame) == SdoAnswer::abort) return sdo_object(frame) == object;
    return compare(frame) == Fit::fits;
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(answer, toggle, object);
  }

 private:
  static bool initiates(SdoAnswer kind) noexcept {
    return kind == SdoAnswer::upload_initiate || kind == SdoAnswer::download_initiate;
  }
};

}  // namespace takt
