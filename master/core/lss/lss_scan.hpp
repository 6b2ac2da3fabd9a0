#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "eds_parser/table/lss_plan.hpp"
#include "master/wire/lss.hpp"

namespace takt {

/// State of a scan.
enum class LssScanState : std::uint8_t { running, found, nobody, lost };

/// Finds the LSS address of a device without node-ID bit by bit; of several devices, it finds the
/// one with the lowest address. That device is then in configuration state. CiA 305, 3.9.5.
///
/// | question | reaction                    | next question                       |
/// | -------- | --------------------------- | ----------------------------------- |
/// | anybody  | answer                      | bit, of the first part              |
/// | anybody  | silence, for the first time | anybody                             |
/// | anybody  | silence again               | (nobody, lost)                      |
/// | bit      | any: an answer means 0      | bit, part                           |
/// | part     | answer                      | bit of the next part, (found, lost) |
/// | part     | silence                     | anybody, (nobody, lost)             |
class LssFastScan {
 public:
  /// Number of questions in a scan that no device answers.
  static constexpr std::uint32_t frames_of_silence = 2;

  LssFastScan() = default;
  /// The scan does not ask for the bits in `mask`; it takes them from `known`.
  LssFastScan(const LssAddress& known, const LssAddress& mask) noexcept
      : known_{known}, mask_{mask} {}

  /// Returns the next question, valid while the scan is running.
  lss::FastScan question() const noexcept { return question_; }
  /// Reports to the scan whether a device has answered the question.
  void on_reaction(bool answered) noexcept;
  LssScanState state() const noexcept { return state_; }
  /// Returns the address that was found, valid in LssScanState::found.
  const LssAddress& address() const noexcept { return address_; }
  /// Returns true if a device may be in configuration state because it has received the last
  /// question, even if its answer was lost.
  bool may_have_switched() const noexcept { return may_have_switched_; }
  /// Returns true if the caller must wait for the full time-out. The reason is an impossible
  /// reaction to a question, or that this is the last question: a late answer to it would confirm a
  /// wrong address or leave a device in configuration state.
  bool doubtful() const noexcept { return doubtful_ || at_the_end(); }

 private:
  /// The subject of the present question.
  enum class Asks : std::uint8_t { anybody, bit, part };

  bool at_the_end() const noexcept { return question_.bit_check == 0 && question_.part == 3; }
  void start_over() noexcept;
  void keep_unanswered() noexcept;
  void begin_part(std::uint8_t part) noexcept;
  void ask_anybody() noexcept;
  void ask_below(int bit) noexcept;
  void on_anybody(bool answered) noexcept;
  void on_part(bool answered) noexcept;

  LssAddress known_{};
  LssAddress mask_{};
  LssAddress address_{};
  lss::FastScan question_{};
  LssScanState state_ = LssScanState::running;
  Asks asks_ = Asks::anybody;
  bool doubtful_ = false;
  std::uint8_t confirmed_ = 0;  // number of confirmed parts of address_
  std::uint8_t restarts_ = 0;
  std::optional<LssAddress> unanswered_;  // the lowest address that no device has confirmed
  bool may_have_switched_ = false;
};

/// Finds the lowest LSS address in ranges of revision number and serial number of one product by
/// halving the ranges. Devices with a node-ID answer as well; their state does not change. CiA
/// 305, 3.9.4.
///
/// | question   | reaction                 | next question       |
/// | ---------- | ------------------------ | ------------------- |
/// | everything | answer                   | lower_half, address |
/// | everything | silence                  | (nobody)            |
/// | lower_half | any: it selects the half | lower_half, address |
/// | address    | answer                   | (found)             |
/// | address    | silence                  | (lost)              |
class LssSlowScan {
 public:
  LssSlowScan() = default;
  /// `ranges`: vendor-ID, product code, lowest and highest revision number, lowest and highest
  /// serial number.
  explicit LssSlowScan(const std::array<std::uint32_t, 6>& ranges) noexcept
      : left_{ranges}, question_{ranges} {}

  /// Returns the six numbers of the next question, valid while the scan is running.
  const std::array<std::uint32_t, 6>& question() const noexcept { return question_; }
  void on_reaction(bool answered) noexcept;
  LssScanState state() const noexcept { return state_; }
  /// Returns the address that was found, valid in LssScanState::found.
  LssAddress address() const noexcept { return {left_[0], left_[1], left_[2], left_[4]}; }

 private:
  /// The subject of the present question: all ranges, the lower half of a range, or the only
  /// remaining address.
  enum class Asks : std::uint8_t { everything, lower_half, address };

  void ask() noexcept;
  /// Returns the index of the lowest number of the range that is halved.
  std::size_t halved() const noexcept { return left_[2] != left_[3] ? 2 : 4; }

  std::array<std::uint32_t, 6> left_{};  // the ranges that still contain the device
  std::array<std::uint32_t, 6> question_{};
  LssScanState state_ = LssScanState::running;
  Asks asks_ = Asks::everything;
};

}  // namespace takt
