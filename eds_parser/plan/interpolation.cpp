#include <cmath>
#include <string>

#include "eds_parser/plan/device/node_objects.hpp"
#include "eds_parser/plan/network_parts.hpp"
#include "eds_parser/report/message.hpp"
#include "eds_parser/specification/object_units.hpp"

namespace takt {
namespace {

std::string period_text(double us) {
  return microseconds_text(static_cast<std::uint64_t>(std::llround(us)));
}

bool is_point(const EffectiveEntry& entry) {
  return first_axis(entry.object.index) == 0x60C1 && entry.object.sub == 1;
}

/// Checks whether the points of one RPDO come as often as the drive takes them from its buffer.
class PointSupply {
 public:
  PointSupply(const NodePdos& node, const EffectivePdo& pdo, const EffectiveEntry& point,
              std::uint32_t sync_period_us)
      : node_{node}, pdo_{pdo}, point_{point}, sync_period_us_{sync_period_us} {}

  void judge(NetworkReport& report) const {
    if (!pdo_.synchronous() || pdo_.transmission == 0) {
      report.warning(pdo_.pos, rule, subject(), ", but is not sent with each SYNC (transmission ",
                     unsigned{pdo_.transmission},
                     "): the buffer of the drive runs empty when a point is late, and the axis "
                     "stops. Write `transmission: 1`");
      return;
    }
    const double supply = sync_period_us_ * static_cast<double>(pdo_.transmission);
    const double demand = taken_every_us();
    if (std::abs(supply - demand) < 0.5) return;
    if (supply > demand) {
      report.warning(pdo_.pos, rule, subject(), " every ", period_text(supply),
                     ", but the drive takes one every ", period_text(demand),
                     " (0x60C2): its buffer runs empty, and the axis stops in every period. ",
                     advice());
      return;
    }
    report.warning(pdo_.pos, rule, subject(), " every ", period_text(supply),
                   ", but the drive takes one only every ", period_text(demand),
                   " (0x60C2): ", filling(supply, demand), advice());
  }

 private:
  static constexpr const char* rule = "interpolation-buffer";

  std::string subject() const {
    return concat(pdo_.label(*node_.node.spec), " carries points of interpolated position mode (",
                  point_.object, ")");
  }
  ObjectKey object(std::uint16_t first, std::uint8_t sub) const {
    const auto axis = static_cast<std::uint16_t>(point_.object.index - 0x60C1);
    return {static_cast<std::uint16_t>(first + axis), sub};
  }
  /// The boot sets 0x60C2 to the SYNC period where the network file does not set it and the drive
  /// permits it.
  double taken_every_us() const {
    const NodeSpec& spec = *node_.node.spec;
    const SubObject* value = node_.node.dictionary->find(object(0x60C2, 1));
    const bool set_by_boot =
        *spec.boot && value != nullptr && value->is_writable() && !spec.written(object(0x60C2, 1));
    if (value == nullptr || set_by_boot) return sync_period_us_;
    const double count =
        static_cast<double>(configured_object(node_.node, object(0x60C2, 1)).value_or(1));
    const auto power =
        static_cast<std::int8_t>(configured_object(node_.node, object(0x60C2, 2)).value_or(-3));
    return count * std::pow(10.0, power) * 1e6;
  }
  /// Returns a sentence that says after which time the buffer is full.
  std::string filling(double supply, double demand) const {
    const std::int64_t points =
        configured_object(node_.node, object(0x60C4, 2))
            .value_or(configured_object(node_.node, object(0x60C4, 1)).value_or(1));
    const double cycles = static_cast<double>(points) * demand / (demand - supply);
    return concat("its buffer of ", points, points == 1 ? " point" : " points",
                  " (0x60C4) is full after ", period_text(cycles * supply),
                  ", and further points are lost. ");
  }
  std::string advice() const {
    return pdo_.transmission == 1 ? "Remove the entry of 0x60C2 under `sdo:`"
                                  : "Write `transmission: 1`";
  }

  const NodePdos& node_;
  const EffectivePdo& pdo_;
  const EffectiveEntry& point_;
  std::uint32_t sync_period_us_;
};

}  // namespace

void judge_interpolation(const NodePdos& node, std::uint32_t sync_period_us,
                         NetworkReport& report) {
  if (!is_cia402(node.node)) return;
  for (const EffectivePdo& pdo : node.pdos) {
    if (pdo.is_tpdo || pdo.use != PdoUse::exchanged) continue;
    for (const EffectiveEntry& entry : pdo.mapping) {
      if (is_point(entry)) PointSupply{node, pdo, entry, sync_period_us}.judge(report);
    }
  }
}

}  // namespace takt
