#pragma once
#include <cstdint>
#include <optional>

namespace takt {

/// What the master remembers of one axis between ordered stops: whether its newest statusword said
/// that it is disabled, and nothing was commanded since that could enable it. Bus thread only.
class AxisMemory {
 public:
  /// A statusword this soon after an enabling word may be older than the answer to it.
  static constexpr std::uint8_t settling_cycles = 3;

  /// Once a cycle. `statusword`: as received by PDO, none: it isn't fresh. `controlword`: as it is
  /// commanded by PDO, none: nothing is.
  void look(std::optional<std::int64_t> statusword,
            std::optional<std::int64_t> controlword) noexcept;
  /// Read by SDO.
  void see(std::int64_t statusword) noexcept;
  /// Written by SDO, or by an RPDO on request.
  void write(std::int64_t controlword) noexcept;
  /// Its node says that it is OPERATIONAL although this master has not booted it.
  void note_operational() noexcept { operational_ = true; }

  /// It was seen disabled, and nothing could enable it since.
  bool disabled() const noexcept { return disabled_; }
  bool operational() const noexcept { return operational_; }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(disabled_, written_, operational_, quiet_);
  }

 private:
  bool disabled_ = false;
  bool written_ = false;  ///< the newest word by SDO could enable it
  bool operational_ = false;
  std::uint8_t quiet_ = 0;  ///< cycles without an enabling word, up to settling_cycles
};

}  // namespace takt
