#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "eds_parser/values/time.hpp"
#include "master/core/sdo/sdo_question.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Measures how late an SDO server answers requests that have timed out. This distinguishes a slow
/// server from one that does not answer. If a request is repeated, the first answer may belong to
/// the repetition. Its lateness counts only when another answer comes, because this proves that the
/// first one belonged to the request that had timed out.
class LateAnswers {
 public:
  /// States whether a frame also fits the present request.
  enum class Fits : std::uint8_t { only_earlier, request_under_way };

  /// Notes that the request, which was sent at `sent`, has timed out.
  void timed_out(const SdoQuestion& request, Time sent) noexcept {
    if (count_ == open_.size()) forget(0);
    open_[count_++] = {.request = request, .sent = sent};
  }

  /// Takes a complete frame of the server. Returns true if it answers one of the requests that have
  /// timed out, and not the present request.
  bool take(const Frame& frame, Time now, Fits fits) noexcept {
    const std::size_t at = find(frame, 0);
    if (at == count_) return false;
    if (fits == Fits::request_under_way) {
      if (open_[at].assumed == Time{}) open_[at].assumed = now - open_[at].sent;
      return false;
    }
    const Time assumed = open_[at].assumed;
    longest_ = std::max(longest_, assumed != Time{} ? assumed : now - open_[at].sent);
    forget(at);
    const std::size_t next = find(frame, at);
    // The answers lag behind the requests by one, so this frame is the answer to the next request.
    if (assumed != Time{} && next != count_) open_[next].assumed = now - open_[next].sent;
    return true;
  }

  /// Returns the longest time from a request that had timed out to its answer; 0 means that no such
  /// answer has come.
  Time longest() const noexcept { return longest_; }
  /// Notes that the server was reset and will not answer the earlier requests.
  void forget_requests() noexcept { count_ = 0; }
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
    SdoQuestion request;
    Time sent{};
    /// Lateness of the frame that answers either this request or its repetition; 0 means none.
    Time assumed{};

    template <class Archive>
    void keep(Archive& state) noexcept {
      state(request, sent, assumed);
    }
  };

  /// Returns the first request from `begin` that the frame answers; count_ if there is none.
  std::size_t find(const Frame& frame, std::size_t begin) const noexcept {
    while (begin < count_ && !open_[begin].request.is_answered_by(frame)) ++begin;
    return begin;
  }

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
