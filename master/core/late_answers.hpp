#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {

/// Measures how late an SDO server answers requests that have timed out. This distinguishes a slow
/// server from one that does not answer.
class LateAnswers {
 public:
  /// The request for `object`, which was sent at `sent`, has timed out.
  void timed_out(ObjectKey object, Time sent) noexcept {
    if (count_ == open_.size()) forget(0);
    open_[count_++] = {object, sent};
  }

  /// Takes an answer of the server. Returns true if it answers one of the requests that have timed
  /// out, whatever request is under way now.
  bool take(const Frame& frame, Time now) noexcept {
    const SdoAnswer kind = sdo_answer(frame);
    const bool has_object = kind == SdoAnswer::upload_initiate ||
                            kind == SdoAnswer::download_initiate || kind == SdoAnswer::abort;
    if (!has_object || frame.length < 4) return false;
    for (std::size_t i = 0; i < count_; ++i) {
      if (open_[i].object != sdo_object(frame)) continue;
      longest_ = std::max(longest_, now - open_[i].sent);
      forget(i);
      return true;
    }
    return false;
  }

  /// The longest time from a request that had timed out to its answer; 0 means that no such answer
  /// has come.
  Time longest() const noexcept { return longest_; }
  void reset() noexcept {
    count_ = 0;
    longest_ = Time{};
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(open_, longest_);
    state.position(count_, open_.size() + 1);
  }

 private:
  struct Open {
    ObjectKey object;
    Time sent{};

    template <class Archive>
    void keep(Archive& state) noexcept {
      state(object, sent);
    }
  };

  void forget(std::size_t at) noexcept {
    std::copy(open_.begin() + static_cast<std::ptrdiff_t>(at) + 1,
              open_.begin() + static_cast<std::ptrdiff_t>(count_),
              open_.begin() + static_cast<std::ptrdiff_t>(at));
    --count_;
  }

  std::array<Open, 8> open_{};
  std::size_t count_ = 0;
  Time longest_{};
};

}  // namespace takt
