#include <array>
#include <string>

#include "eds_parser/print/names.hpp"
#include "eds_parser/print/plan/pdo_picture.hpp"
#include "eds_parser/print/plan/plan_names.hpp"
#include "eds_parser/print/plan/plan_sections.hpp"

namespace takt {
namespace {

class NodeText {
 public:
  NodeText(PlanLines& lines, const BusPlan& plan) : lines_{lines}, plan_{plan} {}

  void node(std::size_t index) {
    const NodePlan& node = plan_.nodes[index];
    lines_.line("");
    lines_.line("node {} {}: {} ({})", node.id.value(), node.name,
                node.product_name.empty() ? "unnamed product" : node.product_name,
                node.description_file);
    std::string traits = node.cia402 ? "CiA 402 drive" : "";
    const auto add = [&](const std::string& text) {
      traits += (traits.empty() ? "" : ", ") + text;
    };
    if (node.mandatory) add("mandatory");
    if (!node.boot) add("only watched: no NMT, no SDO");
    add(watching(node));
    if (node.on_loss != LossReaction::report) add(reaction_text(node));
    if (node.emcy_cob_id) add("EMCY on " + to_string(*node.emcy_cob_id));
    lines_.line("  {}", traits);
    identity(node);
    lss(node);
    device_data(node);
    homing(node);
    for (const bool is_tpdo : {true, false}) {
      for (const PdoRow& row : is_tpdo ? plan_.pdos.tpdos : plan_.pdos.rpdos) {
        if (row.node_index == index) pdo(row, is_tpdo);
      }
    }
  }

 private:
  std::string reaction_text(const NodePlan& node) const {
    const std::string group = node.group == 0 ? "" : plan_.groups[node.group - 1U];
    if (node.on_loss == LossReaction::stop_node) return "its loss stops this node";
    if (node.on_loss == LossReaction::stop_group) return "its loss stops the group " + group;
    return "its loss causes a quick stop of " +
           (group.empty() ? "all drives" : "the drives of the group " + group);
  }

  static std::string watching(const NodePlan& node) {
    if (node.heartbeat_timeout != Time{}) {
      return "missing after " + span_text(node.heartbeat_timeout) + " without heartbeat";
    }
    if (node.guard.period == Time{}) return "no heartbeat: the master does not notice its loss";
    return "guarded every " + span_text(node.guard.period) + ", missing after " +
           span_text(node.guard.life_time());
  }

  void identity(const NodePlan& node) {
    std::string text;
    for (const BootStep& step : node.boot_plan.steps) {
      if (step.action != BootAction::expect) continue;
      text += (text.empty() ? "" : ", ") + step.purpose + " " + value_text(step);
    }
    if (!text.empty()) lines_.line("  identity: {}", text);
  }

  void lss(const NodePlan& node) {
    if (!node.lss) return;
    constexpr std::array<const char*, 4> names{"vendor", "product", "revision", "serial number"};
    std::string known;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (node.lss->known[i] == 0) continue;
      known +=
          std::string{known.empty() ? "" : ", "} + names[i] + " " + hex(node.lss->address[i], 8);
    }
    lines_.line(
        "  a device without node id gets this id by LSS; the master looks for it every second: "
        "{}{}",
        known, node.lss->store ? "; the device stores it" : "; not stored");
  }

  void device_data(const NodePlan& node) {
    if (node.device_data.empty()) return;
    lines_.line("  device data: {} ({})", node.device_data, node.device_data_file);
    for (const std::string& note : node.device_notes) lines_.line("    {}", note);
  }

  void homing(const NodePlan& node) {
    for (const AxisPlan& axis : node.axes) {
      if (!axis.homing) continue;
      lines_.line("  homing{}: {}, {}, at most {}",
                  axis.number == 0 ? "" : fmt::format(" of axis {}", axis.number + 1),
                  axis.homing->required ? "required before absolute motions" : "not required",
                  axis.homing->method ? fmt::format("method {}", *axis.homing->method)
                                      : "with the method of the device",
                  span_text(axis.homing->timeout));
    }
  }

  void pdo(const PdoRow& row, bool is_tpdo) {
    lines_.line("  {}{} {}  {} byte{}  {}{}", is_tpdo ? "TPDO" : "RPDO", row.number,
                to_string(row.cob_id), row.length, row.length == 1 ? "" : "s",
                transmission_name(row.transmission, is_tpdo), pdo_times(row, is_tpdo));
    if (row.field_count != 0 && !row.multiplexed()) {
      for (const std::string& line : pdo_picture(plan_, row)) lines_.line("    {}", line);
    }
    unsigned expected = row.multiplexed() ? 32 : 0;  // the data follow address, index and sub-index
    for (const PdoField& field : plan_.pdos.fields_of(row)) {
      const Signal& signal = plan_.layout.signals[field.signal];
      if (field.bit_offset > expected) gap(expected, field.bit_offset - expected);
      lines_.line("    bit {:>2}..{:<2}  {} {:<12} {}", field.bit_offset,
                  field.bit_offset + field.bits - 1, to_string(signal.object), bits_text(signal),
                  signal.name);
      expected = field.bit_offset + field.bits;
    }
    if (row.on_request || row.multiplexed()) return;
    if (expected + 7 < row.length * 8U) gap(expected, row.length * 8U - expected);
  }

  void gap(unsigned first, unsigned bits) {
    lines_.line("    bit {:>2}..{:<2}  gap", first, first + bits - 1);
  }

  /// Returns the object whose index and sub-index the frames of an MPDO contain.
  static std::string mpdo_object(const PdoRow& row) {
    return to_string(ObjectKey{static_cast<std::uint16_t>(row.header >> 8),
                               static_cast<std::uint8_t>(row.header >> 24)});
  }

  static std::string pdo_times(const PdoRow& row, bool is_tpdo) {
    std::string text;
    if (row.sync_start != 0) text += fmt::format(", first at counter {}", row.sync_start);
    if (row.inhibit != Time{}) text += ", inhibit " + span_text(row.inhibit);
    if (row.event_timer != Time{}) {
      text += (is_tpdo ? ", event timer " : ", repeated after ") + span_text(row.event_timer);
    }
    if (row.deadline != Time{}) text += ", missing after " + span_text(row.deadline);
    if (row.poll != Time{}) text += ", polled every " + span_text(row.poll);
    if (row.poll_syncs != 0) text += fmt::format(", polled every {} SYNCs", row.poll_syncs);
    if (row.drop_late) text += ", not used when late";
    if (row.on_request) text += ", on request only";
    if (row.multiplexed()) {
      const bool by_source = (row.header & 0x80) == 0;
      text += by_source ? ", MPDO by source" : ", MPDO by destination";
      if (by_source && !is_tpdo) text += fmt::format(", as {} of the master", mpdo_object(row));
    }
    return text;
  }

  PlanLines& lines_;
  const BusPlan& plan_;
};

}  // namespace

std::string bits_text(const Signal& signal) {
  return signal.type == DataType::unknown ? fmt::format("{} bits", signal.bits)
                                          : std::string{name(signal.type)};
}

void add_node(PlanLines& lines, const BusPlan& plan, std::size_t index) {
  NodeText{lines, plan}.node(index);
}

}  // namespace takt
