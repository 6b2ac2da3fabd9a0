#include "apps/takt/live/view/axis_view.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <takt/drive402.hpp>

#include "apps/axis/group/find_axes.hpp"
#include "apps/axis/group/speed_pattern.hpp"
#include "apps/takt/live/text/drive_words.hpp"
#include "apps/takt/live/text/node_words.hpp"
#include "eds_parser/values/raw_number.hpp"
#include "master/core/node_status.hpp"
#include "master/explain/emcy_text.hpp"

namespace takt {
namespace {

using Position = AxisSignals::Position;

constexpr std::int32_t axis_step = 0x800;
constexpr std::int32_t object_error_code = 0x603F;
constexpr std::int32_t object_following_error = 0x60F4;
constexpr int mode_interpolated_position = 7;
constexpr int mode_cyclic_position = 8;
constexpr std::int8_t sequence_of_cia402 = 1;
constexpr int mode_velocity = 2;
/// Motions that belong to a cycle further away than this say nothing about the present image.
constexpr std::uint64_t most_cycles_apart = 1000;

/// Finds the values to show for one axis of a bus.
class AxisLook {
 public:
  AxisLook(const BusView& bus, std::int16_t node) : bus_{bus} {
    const auto& nodes = bus.status() ? bus.status()->nodes : no_nodes;
    const auto found = std::ranges::find(nodes, node, &node_status_t::node_id);
    if (found != nodes.end()) node_ = &*found;
  }

  bool fresh(Position at) const { return at && !bus_.stale(*at); }
  std::int64_t raw(std::size_t at) const { return bus_.values()[at]; }
  std::uint16_t word(std::size_t at) const { return static_cast<std::uint16_t>(raw(at)); }

  ShownQuantity quantity(Position at) const {
    if (!fresh(at)) return {};
    const signal_t& signal = bus_.signals()[*at];
    const double number = number_of(static_cast<DataType>(signal.data_type), raw(*at));
    return {.value = number * signal.scale + signal.offset, .unit = signal.unit};
  }
  Position find(std::int32_t object, std::int8_t axis, std::int16_t node) const {
    for (std::size_t i = 0; i < bus_.signals().size(); ++i) {
      const signal_t& signal = bus_.signals()[i];
      const bool same = signal.index == object + (axis - 1) * axis_step && signal.sub == 0;
      if (same && signal.node_id == node && signal.output == 0) return i;
    }
    return std::nullopt;
  }

  /// Returns the state to show: that of the drive, or that of the node while it has not booted.
  PaintedText state(const PaintedText& of_drive, bool knows_drive) const {
    const int boot = node_ == nullptr ? static_cast<int>(BootState::ready) : node_->boot_state;
    const bool only_watched = boot == static_cast<int>(BootState::idle) && knows_drive;
    if (boot == static_cast<int>(BootState::ready) || only_watched) return of_drive;
    return boot_text(*node_);
  }

  /// Returns the error of the drive by its object 0x603F, else by its EMCYs.
  PaintedText error(Position object, bool fault) const {
    if (fresh(object) && word(*object) != 0) return code_text(word(*object));
    if (node_ != nullptr && node_->last_emcy != 0 && (fault || node_->error_register != 0)) {
      return code_text(static_cast<std::uint16_t>(node_->last_emcy));
    }
    if (fault) return {"fault", Paint::bad};
    if (node_ == nullptr || node_->error_register == 0) return {"-", Paint::dim};
    const auto errors = static_cast<std::uint8_t>(node_->error_register);
    return {fmt::format("{:02X} {}", errors, error_register_text(errors)), Paint::bad};
  }

 private:
  static PaintedText code_text(std::uint16_t code) {
    return {fmt::format("{:04X} {}", code, emcy_text(code)), Paint::bad};
  }

  inline static const std::vector<node_status_t> no_nodes;
  const BusView& bus_;
  const node_status_t* node_ = nullptr;
};

PaintedText state_text(std::uint16_t statusword) {
  using enum State402;
  const auto state = decode_statusword(statusword);
  if (!state) return {fmt::format("unknown {:04X}", statusword), Paint::bad};
  if (*state == fault) return {"fault", Paint::bad};
  // The names of the standard are too long for their column.
  if (*state == fault_reaction_active) return {"fault reaction", Paint::bad};
  if (*state == not_ready_to_switch_on) return {"not ready", Paint::warning};
  const Paint paint = *state == operation_enabled   ? Paint::good
                      : *state == quick_stop_active ? Paint::warning
                                                    : Paint::plain;
  return {std::string{name(*state)}, paint};
}

/// Returns the motion that the daemon runs for this axis, or null.
const axis_motion_t* motion_of(const BusView& bus, std::int16_t node, std::int8_t axis) {
  if (!bus.motions()) return nullptr;
  const auto apart = static_cast<std::uint64_t>(bus.cycle()) -
                     static_cast<std::uint64_t>(bus.motions()->cycle) + most_cycles_apart;
  if (apart > 2 * most_cycles_apart) return nullptr;
  const auto& axes = bus.motions()->axes;
  const auto found = std::ranges::find_if(axes, [&](const axis_motion_t& motion) {
    return motion.node_id == node && motion.axis == axis;
  });
  return found == axes.end() || found->state == 0 ? nullptr : &*found;
}

/// Returns the following error that the drive reports, else that of the motion, else the difference
/// of the target and the actual position in a mode that follows the target in each cycle.
ShownQuantity following_error(const BusView& bus, const AxisLook& look, const AxisSignals& signals,
                              std::int8_t number, int mode) {
  const Position stated = look.find(object_following_error, number, signals.node);
  if (look.fresh(stated)) return look.quantity(stated);
  const ShownQuantity actual = look.quantity(signals.position);
  if (!actual.value) return {};
  if (const axis_motion_t* motion = motion_of(bus, signals.node, number)) {
    return {.value = motion->following_error, .unit = actual.unit};
  }
  const bool follows = mode == mode_cyclic_position || mode == mode_interpolated_position;
  const bool enabled =
      look.fresh(signals.statusword) &&
      decode_statusword(look.word(*signals.statusword)) == State402::operation_enabled;
  const ShownQuantity target = look.quantity(signals.target_position);
  if (!follows || !enabled || !target.value) return {};
  return {.value = *target.value - *actual.value, .unit = actual.unit};
}

AxisView view_of(const BusView& bus, const AxisSignals& signals) {
  const AxisLook look{bus, signals.node};
  const Position shown = look.fresh(signals.mode_display) ? signals.mode_display : signals.mode;
  const int mode = look.fresh(shown) ? static_cast<std::int8_t>(look.raw(*shown)) : 0;
  const bool knows = look.fresh(signals.statusword);
  AxisView view{.name = signals.name,
                .node = signals.node,
                .state = {"no statusword", Paint::bad},
                .mode = look.fresh(shown) ? mode_text(mode) : "-",
                .position = look.quantity(signals.position),
                .velocity = look.quantity(signals.velocity),
                .following_error = {},
                .error = {},
                .statusword = {},
                .controlword = {}};
  const std::int8_t number = number_of_axis(bus.signals()[*signals.statusword].index);
  view.following_error = following_error(bus, look, signals, number, mode);
  bool fault = false;
  if (knows) {
    const std::uint16_t word = look.word(*signals.statusword);
    view.statusword = {.value = word, .text = statusword_text(word, mode)};
    view.state = state_text(word);
    fault = decode_statusword(word) == State402::fault;
  }
  view.state = look.state(view.state, knows);
  view.error = look.error(look.find(object_error_code, number, signals.node), fault);
  if (look.fresh(signals.controlword)) {
    const std::uint16_t word = look.word(*signals.controlword);
    view.controlword = {.value = word, .text = controlword_text(word, mode)};
  }
  return view;
}

PaintedText speed_state(const speed_axis_t& axis, std::uint16_t word, double speed) {
  if (shows(axis.fault, word)) return {"fault", Paint::bad};
  if (axis.ready.mask != 0 && !shows(axis.ready, word)) return {"not ready", Paint::plain};
  const bool runs = axis.running.mask != 0 ? shows(axis.running, word) : speed != 0.0;
  if (shows(axis.standstill, word) || !runs) return {"standstill", Paint::good};
  return {speed < 0.0 ? "runs backward" : "runs", Paint::good};
}

Position place(std::int32_t at, const BusView& bus) {
  const bool exists = at >= 0 && static_cast<std::size_t>(at) < bus.signals().size();
  return exists ? Position{static_cast<std::size_t>(at)} : std::nullopt;
}

AxisView view_of(const BusView& bus, const speed_axis_t& axis) {
  const AxisLook look{bus, axis.node_id};
  const Position status = place(axis.status, bus);
  const Position control = place(axis.control, bus);
  const Position actual = place(axis.actual_speed, bus);
  const bool cia402 = axis.sequence == sequence_of_cia402;
  const bool knows = look.fresh(status);
  const std::uint16_t word = knows ? look.word(*status) : std::uint16_t{0};
  AxisView view{.name = axis.node,
                .node = axis.node_id,
                .state = {"no status word", Paint::bad},
                .mode = cia402 ? "vl" : "speed",
                .position = {},
                .velocity = {.value = {}, .unit = axis.unit},
                .following_error = {},
                .error = {},
                .statusword = {},
                .controlword = {}};
  if (look.fresh(actual)) {
    const double way = shows(axis.reverse, word) ? -1.0 : 1.0;
    view.velocity.value = way * static_cast<double>(look.raw(*actual)) * axis.actual_scale;
  }
  if (knows) {
    view.state = speed_state(axis, word, view.velocity.value.value_or(0.0));
    view.statusword = {
        .value = word,
        .text = cia402 ? statusword_text(word, mode_velocity) : speed_words(axis, word)};
  }
  view.state = look.state(view.state, knows);
  view.error = look.error(std::nullopt, knows && shows(axis.fault, word));
  if (look.fresh(control)) {
    const std::uint16_t command = look.word(*control);
    view.controlword = {
        .value = command,
        .text = cia402 ? controlword_text(command, mode_velocity) : speed_command(axis, command)};
  }
  return view;
}

}  // namespace

std::vector<AxisView> axes_of(const BusView& bus) {
  std::vector<AxisView> axes;
  if (bus.values().empty()) return axes;
  const auto speed_axes = bus.speed_axes();
  for (const AxisSignals& signals : find_axes(bus.signals())) {
    const auto found = std::ranges::find(speed_axes, signals.node, &speed_axis_t::node_id);
    if (found == speed_axes.end()) axes.push_back(view_of(bus, signals));
  }
  for (const speed_axis_t& axis : speed_axes) axes.push_back(view_of(bus, axis));
  return axes;
}

std::vector<const node_status_t*> other_nodes(const BusView& bus,
                                              const std::vector<AxisView>& axes) {
  std::vector<const node_status_t*> nodes;
  if (!bus.status()) return nodes;
  for (const node_status_t& node : bus.status()->nodes) {
    const auto axis = std::ranges::find(axes, node.node_id, &AxisView::node);
    if (axis == axes.end()) nodes.push_back(&node);
  }
  return nodes;
}

}  // namespace takt
