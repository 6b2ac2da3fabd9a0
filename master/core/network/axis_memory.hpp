#pragma once
#include <cstdint>
#include <optional>
#include <utility>

namespace takt {

/// The behaviour of a drive at a quick stop, if a boot has read it.
enum class QuickStop : std::uint8_t {
  unread,
  brakes,
  coasts,  ///< 0x605A is 0: the quick stop disables the drive at once.
};

/// Remembers between ordered stops whether an axis is disabled. This is the case if its newest
/// statusword has shown it, and no later command could enable the axis. In case of doubt, an axis
/// counts as not disabled. Bus thread only.
class AxisMemory {
 public:
  /// A statusword that comes within this number of cycles after an enabling controlword may have
  /// been sent before the drive has processed that controlword.
  static constexpr std::uint8_t settling_cycles = 3;
  /// Number of cycles that a drive may need to act on an enabling controlword that a service has
  /// written, for example while it charges its intermediate circuit.
  static constexpr std::uint8_t standing_cycles = 100;

  /// Returns true if a TPDO with the statusword has come since the previous call. `frames` counts
  /// its frames.
  bool has_new_frames(std::uint32_t frames) noexcept {
    return std::exchange(frames_, frames) != frames;
  }
  /// Call this once a cycle. `statusword` is the one that was received by PDO; it is empty unless
  /// has_new_frames() is true. `controlword` is the one that PDOs command; it is empty if they
  /// command nothing.
  void look(std::optional<std::int64_t> statusword,
            std::optional<std::int64_t> controlword) noexcept;
  /// Takes a statusword that was read by SDO.
  void see(std::int64_t statusword) noexcept;
  /// Notes that a service (an SDO download, or an RPDO on request) was requested to write this
  /// controlword.
  void write(std::int64_t controlword) noexcept;
  /// Returns true if a service that writes a controlword may not be answered yet.
  bool awaits_answer() const noexcept { return word_ == ServiceWord::under_way; }
  /// Notes that all services that can write a controlword are answered.
  void note_answer() noexcept {
    if (awaits_answer()) word_ = ServiceWord::standing;
  }
  /// Notes that a stop which commands the axis itself has seen it at standstill and then disabled.
  void confirm() noexcept;
  /// Notes that the node reports OPERATIONAL although this master has not booted it.
  void note_operational() noexcept { operational_ = true; }

  /// Notes the behaviour at a quick stop that the newest boot has read.
  void note_quick_stop(QuickStop what) noexcept { quick_stop_ = what; }

  QuickStop quick_stop() const noexcept { return quick_stop_; }
  /// Returns true if no enabling controlword is on its way to the drive, and the drive has had
  /// enough time to react to each earlier one.
  bool quiet() const noexcept {
    return word_ == ServiceWord::harmless && quiet_ >= settling_cycles;
  }
  /// Returns true if the axis was seen disabled, and nothing could enable it since.
  bool disabled() const noexcept { return disabled_; }
  /// Returns true if the node has reported OPERATIONAL although this master has not booted it.
  bool operational() const noexcept { return operational_; }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(disabled_, word_, operational_, quiet_, frames_, quick_stop_);
  }

 private:
  /// The effect of services that have written the controlword.
  enum class ServiceWord : std::uint8_t {
    harmless,   ///< No service has written an enabling controlword, or the drive was seen to ignore
                ///< it.
    under_way,  ///< An enabling controlword was requested. It may reach the drive at any time.
    standing,   ///< The service is answered. The enabling controlword may still be effective in the
                ///< drive.
  };

  bool disabled_ = false;
  ServiceWord word_ = ServiceWord::harmless;
  bool operational_ = false;
  std::uint8_t quiet_ = 0;    ///< Cycles without an enabling word, at most standing_cycles.
  std::uint32_t frames_ = 0;  ///< value at the previous call of has_new_frames()
  QuickStop quick_stop_ = QuickStop::unread;
};

}  // namespace takt
