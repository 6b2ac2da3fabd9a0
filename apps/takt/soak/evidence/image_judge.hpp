#pragma once
#include <cstdint>
#include <vector>

#include "apps/takt/soak/evidence/verdict.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/rt/exchange/process_image.hpp"
#include "master/sim/bus/wire_frame.hpp"

namespace takt::soak {

/// Returns `count` bits of the frame's data from bit `offset` on, least significant first. CiA 301,
/// 7.1.4.
std::uint64_t bits_of(const Frame& frame, unsigned offset, unsigned count) noexcept;

/// Returns a mask of the lowest `bits` bits.
constexpr std::uint64_t mask_of(unsigned bits) noexcept {
  return bits >= 64 ? ~0ULL : (1ULL << bits) - 1;
}

/// Returns true for values that may be sent without a fresh command: those of the fallback and of
/// the ordered stop, the safe value, and positions that a drive holds. A controlword is lasting if
/// it does not enable operation.
bool is_lasting(const BusPlan& plan, const Signal& signal, std::uint64_t value) noexcept;

/// Checks each image against the frames on the wire: the values of one PDO come from one frame,
/// that frame is not older than the one in the image before, and cycle numbers and times rise.
class ImageJudge final : public sim::BusObserver {
 public:
  ImageJudge(const BusPlan& plan, Verdict& verdict);

  void on_wire(const sim::WireFrame& wire) noexcept override;
  void judge(const ImageView& image);
  std::uint64_t images() const noexcept { return images_; }
  std::uint64_t frames() const noexcept { return frames_; }

 private:
  /// Number of frames kept of each PDO. The receive queue of a stalled master keeps the oldest 1024
  /// frames and drops newer ones. Meanwhile a babbling device may send a frame every 60 us, so the
  /// history covers two seconds of such frames.
  static constexpr std::size_t depth = 32768;

  struct History {
    std::vector<Frame> frames = std::vector<Frame>(depth);
    std::uint64_t seen = 0;
    std::uint64_t matched = 0;  ///< number of the frame in the last image, counted from 1
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

}  // namespace takt::soak
