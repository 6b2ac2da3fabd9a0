#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "master/motion/beat/axis_report.hpp"
#include "master/rt/exchange/seqlock.hpp"

namespace takt {

/// The reports of all axes in one beat, which is the cycle of this number.
struct MotionSnapshot {
  std::uint64_t cycle = 0;  ///< 0: no message about motions has come, so there are no reports
  std::vector<motion::AxisReport> axes{};  ///< in the order of motion_axes()
};

/// The newest reports of all axes for the front thread. The bus thread writes them in each beat;
/// the front thread may read them at any time.
class MotionBoard {
 public:
  explicit MotionBoard(std::size_t axes)
      : axes_{axes}, lock_{(head_words + axes * axis_words) * sizeof(std::uint64_t)} {}

  /// The bus thread writes the reports of one beat.
  void write(std::uint64_t cycle, std::span<const motion::AxisReport> reports) noexcept {
    lock_.begin();
    lock_.put(0, cycle);
    for (std::size_t i = 0; i < reports.size() && i < axes_; ++i) {
      lock_.put(head_words + i * axis_words, reports[i]);
    }
    lock_.end();
  }
  /// The front thread reads the newest reports.
  void read(MotionSnapshot& snapshot) const {
    snapshot.axes.resize(axes_);
    lock_.read([&] {
      lock_.get(0, snapshot.cycle);
      for (std::size_t i = 0; i < axes_; ++i) {
        lock_.get(head_words + i * axis_words, snapshot.axes[i]);
      }
    });
  }

 private:
  static constexpr std::size_t head_words = 1;
  static constexpr std::size_t axis_words = seqlock_words<motion::AxisReport>;

  std::size_t axes_;
  Seqlock lock_;
};

}  // namespace takt
