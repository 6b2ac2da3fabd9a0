#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <takt/drive402.hpp>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/rt/controller.hpp"

namespace takt {

/// Makes set-points without an application: enables every CiA 402 axis whose PDOs carry
/// controlword, statusword, target position and actual position, and moves it along a sine that
/// starts at its actual position. All other outputs are zero.
class SineMotion final : public Controller {
 public:
  struct Value {
    SignalIndex signal = 0;
    std::int64_t value = 0;
  };

  explicit SineMotion(const BusPlan& plan);

  /// Returns all set-points that answer this image. The span is valid until the next call.
  std::span<const Value> next(const ImageView& image) noexcept;
  void update(const ImageView& image, OutputWriter& outputs) noexcept override;
  std::size_t axes() const noexcept { return axes_.size(); }
  /// Returns the greatest number of axes that have moved at the same time.
  std::size_t most_moving() const noexcept { return most_moving_; }

 private:
  struct Axis {
    SignalIndex controlword = 0;
    SignalIndex statusword = 0;
    SignalIndex target = 0;
    SignalIndex actual = 0;
    std::optional<SignalIndex> mode{};
    double amplitude = 0;  ///< counts
    DriveSequence sequence{};
    bool fault = false;  ///< the drive is in fault, and a reset has been requested
    std::optional<Time> since{};
    double centre = 0;
  };

  void find_axes(const BusPlan& plan);
  void lead(Axis& axis, const ImageView& image) noexcept;
  double stroke(Time moved) noexcept;
  void set(SignalIndex signal, std::int64_t value) noexcept { values_.push_back({signal, value}); }

  std::vector<Axis> axes_;
  std::vector<SignalIndex> others_;
  std::vector<Value> values_;  ///< has room for all outputs
  std::size_t most_moving_ = 0;
  Time stroke_at_{};  ///< stroke_ is the result for this time
  double stroke_ = 0;
};

}  // namespace takt
