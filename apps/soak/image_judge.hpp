#pragma once
#include <cstdint>
#include <vector>

#include "apps/soak/verdict.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/rt/process_image.hpp"
#include "master/sim/wire_frame.hpp"

namespace takt {

/// `count` bits of a frame from bit `offset` on, least significant first. CiA 301, 7.1.4.
std::uint64_t bits_of(const Frame& frame, unsigned offset, unsigned count) noexcept;

/// Holds each image against what was on the wire: the values of one PDO come from one frame, that
/// frame is not older than the one before, cycle numbers and times rise.
class ImageJudge final : public sim::BusObserver {
 public:
  ImageJudge(const BusPlan& plan, Verdict& verdict);

  void on_wire(const sim::WireFrame& wire) noexcept override;
  void judge(const ImageView& image);
  std::uint64_t images() const noexcept { return images_; }
  std::uint64_t frames() const noexcept { return frames_; }

 private:
  /// Frames kept of each PDO. A receive queue holds 1024 and drops the newest: while the master is
  /// stalled and a device babbles, a frame each 60 us, all others of two seconds pass.
  static constexpr std::size_t depth = 32768;

  struct History {
    std::vector<Frame> frames = std::vector<Frame>(depth);
    std::uint64_t seen = 0;
    std::uint64_t matched = 0;  ///< the image showed this frame; frames are counted from 1
  };

  bool shows(const PdoRow& row, const Frame& frame, const ImageView& image) const noexcept;
  bool unchanged(const PdoRow& row, const ImageView& image) const noexcept;
  bool find(const PdoRow& row, History& history, const ImageView& image) const noexcept;

  const BusPlan& plan_;
  Verdict& verdict_;
  std::vector<History> rows_;
  std::vector<std::int64_t> last_;
  std::uint64_t cycle_ = 0;
  Time published_{};
  std::uint64_t images_ = 0;
  std::uint64_t frames_ = 0;
};

}  // namespace takt
