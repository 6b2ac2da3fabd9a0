#include "test/budget/stuffed_frame.hpp"

#include "master/sim/bus/frame_bits.hpp"

namespace takt {

Frame stuffed(const PlanFrame& what, sim::Random& random) {
  Frame best{.id = what.cob_id, .length = what.bytes, .rtr = what.remote_request};
  std::uint16_t most = sim::frame_bits(best).total;
  Frame frame = best;
  for (unsigned attempt = 0; attempt < 400 && what.bytes != 0 && !what.remote_request; ++attempt) {
    // Behind a run of five equal bits, each run of four makes another stuff bit. Random bytes are
    // for the stuff bits of the CRC.
    const auto pattern = static_cast<std::uint8_t>(0x0F0F >> (attempt % 8));
    const bool again = attempt >= 100 && attempt % 2 == 1;  // begin with the best data so far
    if (again) frame.data = best.data;
    if (!again) frame.data.fill(pattern);
    for (unsigned i = 0; i < attempt / 8 % 4 + (again ? 1U : 0U); ++i) {
      frame.data[random.below(what.bytes)] = static_cast<std::uint8_t>(random.next());
    }
    for (std::size_t i = what.bytes; i < 8; ++i) frame.data[i] = 0;
    const std::uint16_t total = sim::frame_bits(frame).total;
    if (total <= most) continue;
    most = total;
    best = frame;
  }
  return best;
}

}  // namespace takt
