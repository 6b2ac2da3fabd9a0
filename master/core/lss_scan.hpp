#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "eds_parser/table/lss_plan.hpp"
#include "master/wire/lss.hpp"

namespace takt {

enum class LssScanState : std::uint8_t { running, found, nobody, lost };

/// Finds the LSS address of a device without node id, bit by bit; of several the lowest. It is then
/// in configuration state. CiA 305, 3.9.5.
class LssFastScan {
 public:
  /// Nobody has answered: that many questions.
  static constexpr std::uint32_t frames_of_silence = 2;

  LssFastScan() = default;
  /// Bits of `mask` are known and need no question.
  LssFastScan(const LssAddress& known, const LssAddress& mask) noexcept
      : known_{known}, mask_{mask} {}

  /// What to ask next, while running.
  lss::FastScan question() const noexcept { return question_; }
  /// Somebody has answered it, or nobody has.
  void on_reaction(bool answered) noexcept;
  LssScanState state() const noexcept { return state_; }
  const LssAddress& address() const noexcept { return address_; }
  /// A device that heard the last question is in configuration state, even where its answer was
  /// lost.
  bool may_have_switched() const noexcept { return may_have_switched_; }
  /// Wait for as long as may be: a question had a reaction that can't be, or this is the end,
  /// where a late answer would confirm a wrong address or leave a device in configuration state.
  bool doubtful() const noexcept { return doubtful_ || at_the_end(); }

 private:
  bool at_the_end() const noexcept { return question_.bit_check == 0 && question_.part == 3; }
  void start_over() noexcept;
  void keep_unheard() noexcept;
  void begin_part(std::uint8_t part) noexcept;
  void ask_below(int bit) noexcept;
  void on_anybody(bool answered) noexcept;
  void on_confirm(bool answered) noexcept;

  LssAddress known_{};
  LssAddress mask_{};
  LssAddress address_{};
  lss::FastScan question_{};
  LssScanState state_ = LssScanState::running;
  bool confirming_ = false;
  bool doubtful_ = false;
  std::uint8_t confirmed_ = 0;  // parts of address_
  std::uint8_t restarts_ = 0;
  std::optional<LssAddress> unheard_;  // the lowest that nobody has confirmed
  bool may_have_switched_ = false;
};

/// Finds the lowest LSS address in ranges of revision and serial number of one product, by halving
/// them; devices with a node id answer as well and stay as they are. CiA 305, 3.9.4.
class LssSlowScan {
 public:
  LssSlowScan() = default;
  /// `ranges`: vendor, product, revision from and to, serial from and to.
  explicit LssSlowScan(const std::array<std::uint32_t, 6>& ranges) noexcept
      : left_{ranges}, question_{ranges} {}

  /// The six numbers to ask for next, while running.
  const std::array<std::uint32_t, 6>& question() const noexcept { return question_; }
  void on_reaction(bool answered) noexcept;
  LssScanState state() const noexcept { return state_; }
  LssAddress address() const noexcept { return {left_[0], left_[1], left_[2], left_[4]}; }

 private:
  void ask() noexcept;

  std::array<std::uint32_t, 6> left_{};  // where the device is
  std::array<std::uint32_t, 6> question_{};
  LssScanState state_ = LssScanState::running;
  bool first_ = true;
  bool confirming_ = false;
};

}  // namespace takt
