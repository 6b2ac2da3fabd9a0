#include "apps/takt/soak/intruder.hpp"

#include <array>

namespace takt::soak {

void Intruder::act() noexcept {
  std::array<StampedFrame, 64> heard;
  while (port_.receive(heard) == heard.size()) {
  }
  if (gone_) return;
  if (random_.chance(0.001)) activity_ = random_.chance(0.7) ? 0 : 0.01 * random_.below(60);
  for (int i = 0; i < 8 && random_.chance(activity_); ++i) {
    const Frame next = frame();
    sent_ += port_.send({&next, 1}, world_.now()).sent;
  }
}

Frame Intruder::frame() noexcept {
  Frame frame{.id = identifier()};
  frame.length = static_cast<std::uint8_t>(random_.below(9));
  if (random_.chance(0.5)) frame.length = 8;
  frame.rtr = random_.chance(0.02);
  for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(random_.below(256));
  const bool nmt = frame.id == CobId::base(0);
  if (nmt && random_.chance(0.5)) {
    constexpr std::array<std::uint8_t, 5> commands{1, 2, 128, 129, 130};
    frame.length = 2;
    frame.data[0] = commands[random_.below(commands.size())];
    frame.data[1] = static_cast<std::uint8_t>(random_.below(16));
  } else if (random_.chance(0.5)) {
    // An SDO response that may fit: an initiate, a segment or an abort.
    frame.data[0] = static_cast<std::uint8_t>(random_.below(8) << 5 | random_.below(32));
    frame.data[1] = static_cast<std::uint8_t>(random_.below(4));
    frame.data[2] = static_cast<std::uint8_t>(0x10 + random_.below(16));
    frame.data[3] = static_cast<std::uint8_t>(random_.below(6));
  }
  return frame;
}

CobId Intruder::identifier() noexcept {
  const std::uint32_t node =
      plan_.nodes[random_.below(static_cast<std::uint32_t>(plan_.nodes.size()))].id.value();
  const auto row = [&](std::size_t rows) {
    return random_.below(static_cast<std::uint32_t>(rows));
  };
  switch (random_.below(8)) {
    case 0:
      return CobId::base(0x580 + node);
    case 1:
      return CobId::base(0x080 + (random_.chance(0.5) ? node : 0));
    case 2:
      return CobId::base(0x700 + node);
    case 3:
      return CobId::base(0x600 + node);
    case 4:
      if (plan_.pdos.tpdos.empty()) return CobId::base(0x181);
      return plan_.pdos.tpdos[row(plan_.pdos.tpdos.size())].cob_id;
    case 5:
      return random_.chance(0.2) ? CobId::base(0) : CobId::base(random_.below(0x800));
    case 6:
      return CobId::extended(random_.below(0x2000'0000));
    default:
      return CobId::base(random_.below(0x800));
  }
}

}  // namespace takt::soak
