#pragma once
#include <span>

#include "master/rt/beat/beat.hpp"
#include "master/rt/exchange/exchange.hpp"
#include "master/rt/exchange/front_link.hpp"
#include "master/rt/frame_sender.hpp"
#include "master/rt/machines/bus_machines.hpp"
#include "master/rt/port.hpp"
#include "master/wire/wire_time.hpp"

namespace takt {

/// Turns the newest set-points into the RPDO frames of this cycle, and sends them. They take effect
/// at the next SYNC. Bus thread only.
template <Port P, FrontLink L, Services S>
class OutputStage {
 public:
  /// Keeps references to all arguments.
  OutputStage(P& port, L& front, const Beat& beat, FrameSender<P>& sender,
              BusMachines<S>& bus) noexcept
      : port_{port}, front_{front}, beat_{beat}, sender_{sender}, bus_{bus} {}

  void send() noexcept {
    const Time now = port_.now();
    const SetPointFrame& commands = front_.set_points();
    const OutputMoment moment{.cycle = beat_.cycle(), .now = now};
    PdoOutputs& outputs = bus_.pdos.outputs();
    std::span<const Frame> frames = outputs.pack(commands.points, moment);
    if (outputs.fresh_commands() != 0) {
      front_.exchange().timing.command_age.record(now - commands.when);
    }
    if (frames.empty()) return;
    // SYNC has precedence: outputs that might not end before the next SYNC are left for the next
    // cycle.
    const Time room = beat_.next_deadline() - now;
    if (bus_.wire.worst(frames) > room) [[unlikely]] {
      frames = outputs.pack_less(bus_.wire.bits_in(room), WireTime::worst_bits);
      bus_.status.outputs_skipped += frames.empty();
    }
    outputs.sent(frames.empty() ? 0 : sender_.send(frames), moment);
  }

 private:
  P& port_;
  L& front_;
  const Beat& beat_;
  FrameSender<P>& sender_;
  BusMachines<S>& bus_;
};

}  // namespace takt
