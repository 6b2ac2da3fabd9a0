#pragma once
#include <cstdint>
#include <optional>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/dictionary/abort.hpp"
#include "master/sim/dictionary/cob_rules.hpp"
#include "master/sim/dictionary/object_store.hpp"
#include "master/wire/bytes.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// The time of day of a device. TIME sets it if bit 31 of 0x1012 is set. CiA 301, 7.2.6 and
/// 7.5.2.15.
class TimeConsumer {
 public:
  explicit TimeConsumer(ObjectStore& store) : cob_{store.find({0x1012, 0})} {}

  void reset() noexcept { set_.reset(); }
  /// Returns the identifier of TIME; empty if the device does not consume TIME.
  std::optional<CobId> id() const noexcept {
    if (cob_ == nullptr || (cob_->value & consumes) == 0) return {};
    return cob_id(cob_->value & ~std::uint64_t{consumes | cob_bit30});
  }
  void on_frame(const Frame& frame, Time now) noexcept {
    if (frame.length != 6) return;
    const auto raw = load_le<std::uint64_t>(std::span{frame.data}.first(6));
    set_ = Setting{.heard = now, .ms = (raw >> 32) * ms_a_day + (raw & 0x0FFF'FFFF)};
  }
  /// Milliseconds since 1984-01-01; empty until the first TIME.
  std::optional<std::uint64_t> now_ms(Time now) const noexcept {
    if (!set_) return {};
    return set_->ms +
           static_cast<std::uint64_t>((now - set_->heard) / std::chrono::milliseconds{1});
  }
  /// Checks a write to 0x1012. The identifier can't change while TIME is consumed. Production of
  /// TIME (bit 30) is refused because the device does not support it.
  Abort check_write(const Object& object, std::uint64_t raw) const noexcept {
    if (&object != cob_) return Abort::none;
    const bool moves = ((raw ^ object.value) & 0x3FFF'FFFF) != 0;
    const bool active = (object.value & consumes) != 0 && (raw & consumes) != 0;
    const CobId wanted = cob_id(raw & 0x3FFF'FFFF);
    const bool bad = has_stray_bits(raw & 0x3FFF'FFFF) || is_restricted(wanted);
    return (raw & cob_bit30) != 0 || bad || (moves && active) ? Abort::value : Abort::none;
  }

 private:
  static constexpr std::uint32_t consumes = 0x8000'0000;
  static constexpr std::uint64_t ms_a_day = 86'400'000;

  struct Setting {
    Time heard{};
    std::uint64_t ms = 0;
  };
  const Object* cob_;
  std::optional<Setting> set_;
};

}  // namespace takt::sim
