#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/waits.hpp"

namespace takt {

/// How far the ordered stop of a bus is.
enum class StopStage : std::uint8_t {
  running,     ///< no stop asked for
  fallback,    ///< every output takes its declared fallback
  quick_stop,  ///< axes get the controlword of a quick stop
  disable,     ///< axes that are still enabled get "disable voltage"
  nmt,         ///< nodes go to pre-operational
  done,        ///< SYNC may end
};

/// One CiA 402 axis: where its words are in the image.
struct StopAxis {
  std::uint8_t node_index = 0;
  SignalIndex controlword = 0;
  std::optional<SignalIndex> statusword;
};

/// What the ordered stop sees once a cycle.
struct StopView {
  std::span<const std::int64_t> values;  ///< the image
  std::span<const bool> exchanging;      ///< per node: its PDOs are exchanged
  bool network_stopped = false;
};

/// Fallback of each axis -> quick stop -> disabled confirmed -> NMT -> end. Each stage has a
/// limit, the whole ends within BusPlan::stop_timeout. CiA 402-2, state machine of the drive.
class OrderedStop {
 public:
  static constexpr std::int64_t quick_stop_word = 0x0002;
  static constexpr std::int64_t disable_voltage_word = 0x0000;

  explicit OrderedStop(const BusPlan& plan);

  void begin(Time now) noexcept;
  /// Once a cycle, before the outputs are packed.
  void step(Time now, const StopView& view) noexcept;

  StopStage stage() const noexcept { return stage_; }
  std::span<const StopAxis> axes() const noexcept { return axes_; }
  /// What the axes' controlwords have to be now; none: what is commanded.
  std::optional<std::int64_t> controlword() const noexcept;

  /// The power stage is off: not ready, switch on disabled, fault, or ready to switch on.
  static constexpr bool disabled(std::int64_t statusword) noexcept {
    const std::int64_t state = statusword & 0x4F;
    return state == 0x00 || state == 0x40 || state == 0x08 || (statusword & 0x6F) == 0x21;
  }

 private:
  bool all_disabled(const StopView& view) const noexcept;
  Time limit() const noexcept;
  void advance() noexcept;

  waits::StopLimits limits_;
  std::vector<StopAxis> axes_;
  StopStage stage_ = StopStage::running;
  Time begun_{};
  std::uint32_t steps_ = 0;  ///< in this stage
};

}  // namespace takt
