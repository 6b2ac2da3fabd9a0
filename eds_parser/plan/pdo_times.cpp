#include <algorithm>
#include <string>

#include "eds_parser/plan/device/device_rules.hpp"
#include "eds_parser/plan/frame_time.hpp"
#include "eds_parser/plan/network_parts.hpp"
#include "eds_parser/specification/device_data.hpp"

namespace takt {
namespace {

/// The times of the sender of an event-driven PDO: the device for a TPDO, the master for an RPDO.
struct SenderTimes {
  std::uint64_t inhibit_us = 0;
  std::uint64_t timer_us = 0;
};

SenderTimes times_of(const EffectivePdo& pdo) {
  if (!pdo.is_tpdo) return {pdo.master_inhibit * 100ULL, pdo.master_timer * 1000ULL};
  return {std::uint64_t{pdo.inhibit_time} * pdo.inhibit_unit_us, pdo.event_timer * 1000ULL};
}

class TimeJudge {
 public:
  TimeJudge(const NodePdos& node, std::uint32_t bitrate, NetworkReport& report)
      : node_{node}, bitrate_{bitrate}, report_{report} {}

  void run() {
    for (const EffectivePdo& pdo : node_.pdos) {
      if (pdo.use != PdoUse::exchanged || pdo.synchronous() || pdo.on_request) continue;
      const SenderTimes times = times_of(pdo);
      deadline(pdo, times);
      if (times.inhibit_us == 0) continue;
      timer(pdo, times);
      frame(pdo, times);
    }
  }

 private:
  std::string label(const EffectivePdo& pdo) const { return pdo.label(*node_.node.spec); }

  /// Returns the place of the value in the network file, or the place of the PDO if the file does
  /// not state the value.
  SourcePos pos(const EffectivePdo& pdo, Sourced<std::uint16_t> PdoSpec::* member) const {
    const PdoSpec* spec = node_.node.spec->pdo(pdo.is_tpdo, pdo.number);
    return spec != nullptr && (spec->*member).given ? (spec->*member).pos : pdo.pos;
  }

  void timer(const EffectivePdo& pdo, const SenderTimes& times) {
    if (times.timer_us == 0 || times.timer_us >= times.inhibit_us) return;
    const std::string inhibit = microseconds_text(times.inhibit_us);
    report_.warning(
        pos(pdo, &PdoSpec::event_timer), "event-timer", "the event timer of ", label(pdo), " (",
        microseconds_text(times.timer_us), ") is shorter than its inhibit time (", inhibit,
        "): the device sends the PDO every ", inhibit, ". Write `event_timer` of at least ",
        (times.inhibit_us + 999) / 1000, " (ms), or a shorter `inhibit_time` (in 100 us)");
  }

  void deadline(const EffectivePdo& pdo, const SenderTimes& times) {
    const std::uint64_t wanted = pdo.master_timer * 1000ULL;
    const std::uint64_t period = std::max(times.inhibit_us, times.timer_us);
    if (!pdo.is_tpdo || wanted == 0 || wanted >= period) return;
    report_.warning(pos(pdo, &PdoSpec::event_deadline), "event-timer", "`event_deadline` of ",
                    label(pdo), " (", microseconds_text(wanted),
                    ") is shorter than the time between two of its frames (",
                    microseconds_text(period), " by ",
                    period == times.inhibit_us ? "its inhibit time" : "its event timer",
                    "): good frames count as missing");
  }

  void frame(const EffectivePdo& pdo, const SenderTimes& times) {
    const std::uint32_t bits = worst_frame_bits(pdo.bytes(), pdo.cob_id.is_extended());
    const auto longest = static_cast<std::uint64_t>(
        std::chrono::ceil<std::chrono::microseconds>(wire_time(bits, bitrate_)).count());
    if (times.inhibit_us >= longest) return;
    report_.warning(
        pos(pdo, &PdoSpec::inhibit_time), "inhibit-time", "the inhibit time of ", label(pdo), " (",
        microseconds_text(times.inhibit_us), ") is shorter than its frame (up to ",
        microseconds_text(longest), " at ", bitrate_ / 1000,
        " kbit/s): the PDO can fill the bus. The inhibit time runs from the first attempt to send, "
        "so write more than the longest wait for the bus, or 0 for no inhibit time");
  }

  const NodePdos& node_;
  std::uint32_t bitrate_;
  NetworkReport& report_;
};

}  // namespace

void judge_pdo_times(const NodePdos& node, std::uint32_t bitrate, NetworkReport& report) {
  TimeJudge{node, bitrate, report}.run();
}

}  // namespace takt
