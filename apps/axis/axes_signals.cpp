#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "apps/axis/axes_state.hpp"
#include "apps/axis/group/signal_format.hpp"
#include "master/lcm/printable_text.hpp"

// Inputs and outputs of all nodes, in their units.

namespace takt {
namespace {

/// Longest wait until an image shows that an output was sent.
constexpr std::chrono::seconds output_time{1};

/// The outputs that control a CiA 402 axis.
constexpr std::array leading_outputs{&AxisSignals::controlword,     &AxisSignals::mode,
                                     &AxisSignals::target_position, &AxisSignals::target_velocity,
                                     &AxisSignals::target_torque,   &AxisSignals::velocity_offset,
                                     &AxisSignals::torque_offset};

bool has_name(const signal_t& signal, std::string_view name) {
  if (!name.starts_with(signal.node + ".")) return false;
  const std::string_view rest = name.substr(signal.node.size() + 1);
  const std::string object = fmt::format("0x{:04X}", signal.index);
  return rest == signal.name || rest == fmt::format("{}:{}", object, signal.sub) ||
         (signal.sub == 0 && rest == object);
}

}  // namespace

std::expected<std::size_t, Obstacle> Axes::State::find_signal(const std::string& name,
                                                              Signals among) const {
  const std::vector<signal_t>& known = group.input().signals();
  std::vector<std::size_t> found;
  std::vector<std::string> others;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const bool fits = among == Signals::all || known[i].output != 0;
    if (fits && has_name(known[i], name)) found.push_back(i);
    if (fits && name.starts_with(known[i].node + ".")) others.push_back(known[i].name);
  }
  if (found.size() == 1) return found.front();
  if (found.size() > 1) {
    const signal_t& first = known[found.front()];
    return obstacle(Obstacle::Kind::wrong_use,
                    fmt::format("bus {} has several values '{}': name the object, '{}.0x{:04X}:{}'",
                                group.bus(), name, first.node, first.index, first.sub));
  }
  if (!others.empty()) {
    return obstacle(
        Obstacle::Kind::wrong_use,
        fmt::format("bus {} has no {} '{}' in its PDOs; this node has: {}", group.bus(),
                    among == Signals::all ? "value" : "output", name, fmt::join(others, ", ")));
  }
  const auto node = node_id(name.substr(0, name.find('.')));
  if (!node) return std::unexpected{node.error()};
  return obstacle(Obstacle::Kind::wrong_use,
                  fmt::format("'{}': this node has no such value in its PDOs", name));
}

std::expected<double, Obstacle> Axes::State::signal(const std::string& name) {
  if (!is_current()) return std::unexpected{restarted().error()};
  const auto place = find_signal(name, Signals::all);
  if (!place) return std::unexpected{place.error()};
  if (group.input().stale(*place)) {
    return obstacle(Obstacle::Kind::blocked, fmt::format("{} has not arrived", name));
  }
  return value_at(*place);
}

double Axes::State::value_at(std::size_t place) const {
  const ValueFormat format = format_of(group.input().signals()[place]);
  return number_of(format.type, group.input().values()[place]) * format.scale + format.offset;
}

bool Axes::State::leads(std::size_t place) const {
  const AxisControl& known = group.axes();
  for (Index i = 0; i < known.size(); ++i) {
    for (const auto output : leading_outputs) {
      if (known.signals(i).*output == place) return true;
    }
  }
  return speed && speed->has_node(group.input().signals()[place].node_id);
}

Done Axes::State::set(const std::string& name, double value) {
  if (!is_current()) return restarted();
  const auto place = find_signal(name, Signals::outputs);
  if (!place) return std::unexpected{place.error()};
  if (leads(*place)) {
    return obstacle(
        Obstacle::Kind::wrong_use,
        fmt::format(
            "{} commands an axis, so enable() and the motions set it: set() is for other outputs",
            name));
  }
  const std::array formats{format_of(group.input().signals()[*place])};
  const auto raw = Units{formats}.raw_of(0, value);
  if (!raw || !fits(formats[0].type, formats[0].bits, *raw)) {
    return obstacle(Obstacle::Kind::wrong_use, fmt::format("{} can't be {}", name, value));
  }
  return set_raw(*place, *raw);
}

/// The value is sent until this object ends, or until this program was silent for longer than its
/// timeout.
Done Axes::State::set_raw(std::size_t place, std::int64_t raw) {
  const std::string& node = group.input().signals()[place].node;
  const std::int16_t id = group.input().signals()[place].node_id;
  if (const NodeHolder& holder = group.holder_of_node(id); holder.is_other()) {
    return obstacle(Obstacle::Kind::blocked,
                    fmt::format("{} belongs to '{}', and the commands of this program are refused",
                                node, printable_text(holder.name)));
  }
  events_.clear();
  if (held_.empty()) last_values_ = Clock::now();
  held_.insert_or_assign(place, raw);
  const auto is_sent = [&] { return group.input().values()[place] == raw; };
  const auto is_over = [&] { return is_sent() || !refusal_of(node).empty(); };
  const auto waited = wait_until(is_over, output_time);
  if (waited && (!*waited || is_sent())) return *waited;
  held_.erase(place);
  const std::string why = refusal_of(node);
  return obstacle(Obstacle::Kind::refused,
                  why.empty() ? fmt::format("{} was not sent: no image shows it", node) : why);
}

/// Returns the reason why taktd has refused the newest values for this node, or an empty text.
std::string Axes::State::refusal_of(const std::string& node) const {
  for (const event_t& event : events_) {
    const bool refused = event.kind == "command_refused" || event.kind == "limit_exceeded";
    if (refused && (event.node == node || event.node.empty())) return event.text;
  }
  return {};
}

void Axes::State::send_held() {
  if (held_.empty()) return;
  command_t command{};
  for (const auto& [place, raw] : held_) {
    command.signals.push_back(static_cast<std::int32_t>(place));
    command.values.push_back(raw);
  }
  group.send_values(command);
}

}  // namespace takt
