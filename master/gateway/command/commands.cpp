#include "master/gateway/command/commands.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "master/core/set_point.hpp"
#include "master/lcm/messages.hpp"
#include "master/units/units.hpp"

namespace takt {
namespace {

constexpr std::size_t longest_sender = 64;
constexpr std::array<std::string_view, command_refusals> refusal_names{
    "observing", "schema",  "session",   "sender", "no_cycle", "future",   "bad_signal",
    "bad_value", "too_old", "not_ready", "held",   "waited",   "overtaken"};

std::uint32_t cycles_in(Time span, Time period) noexcept {
  if (period <= Time{0}) return 1;
  return static_cast<std::uint32_t>(std::max<std::int64_t>(1, span / period));
}

std::string signal_text(const BusPlan& plan, const Signal& signal) {
  return plan.nodes[signal.node_index].name + "." + signal.name;
}

std::string too_old(const command_t& command, const CommandContext& context) {
  return "the command is too old: it is computed from cycle " + std::to_string(command.cycle) +
         ", the present cycle is " + std::to_string(context.cycle);
}

std::string overtaken(const command_t& command) {
  return "the command is older than the newest one of the node: it is computed from cycle " +
         std::to_string(command.cycle);
}

std::string after_release(const command_t& command) {
  return "the command is not newer than the release of its sender: both are computed from cycle " +
         std::to_string(command.cycle);
}

bool is_control(char c) noexcept { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

/// Makes the sender's name printable: it comes from outside and goes to terminals and logs.
std::string shown(const std::string& sender) {
  std::string name = sender.substr(0, longest_sender);
  std::ranges::replace_if(name, is_control, '?');
  return name;
}

}  // namespace

Commands::Commands(const BusPlan& plan, CommandsOptions options, SetOutput set_output,
                   NoticeSink announce)
    : plan_{plan},
      options_{options},
      set_output_{std::move(set_output)},
      announce_{std::move(announce)},
      second_{cycles_in(std::chrono::seconds{1}, plan.cycle.period)},
      leases_{plan.nodes.size(), second_},
      verdicts_(plan.nodes.size()),
      limits_(plan.layout.signals.size()) {}

std::string_view name(CommandRefusal refusal) noexcept {
  return refusal_names[std::to_underlying(refusal)];
}

bool Commands::refuse(const Refused& refused, const std::string& why) {
  const auto& [context, command, reason, node] = refused;
  count(reason);
  const std::string sender = shown(command.sender);
  const std::string thing = sender + '/' + std::to_string(node) + '/' + why.substr(0, 24);
  const auto kept_back = reported_.allow(thing, context.now);
  if (!kept_back) return false;
  std::string text = "command of '" + sender + "' refused";
  if (node != 0)
    text += " for node " + std::to_string(node) + " (" + std::string{node_name(plan_, node)} + ")";
  text += ": " + why;
  if (*kept_back != 0) text += " (" + std::to_string(*kept_back) + " more since the last message)";
  announce_({.when = context.now,
             .cycle = context.cycle,
             .node = node,
             .kind = "command_refused",
             .weight = Weight::warning,
             .text = std::move(text)});
  return false;
}

bool Commands::check_message(const command_t& command, const CommandContext& context) {
  if (options_.observe) {
    return refuse({context, command, CommandRefusal::observing}, "taktd only observes (--observe)");
  }
  if (command.schema != message_schema) {
    return refuse({context, command, CommandRefusal::schema}, schema_refusal(command.schema));
  }
  if (command.session != options_.session) {
    return refuse({context, command, CommandRefusal::session},
                  "the command is for another session of taktd (a replayed log, or taktd has "
                  "restarted); use the session of the newest image_t");
  }
  if (command.sender.empty() || command.sender.size() > longest_sender ||
      std::ranges::any_of(command.sender, is_control)) {
    return refuse({context, command, CommandRefusal::sender},
                  "the sender must have a name of 1 to 64 characters without control characters");
  }
  if (command.instance == 0) {
    return refuse(
        {context, command, CommandRefusal::sender},
        "the command has instance 0; a sender chooses a random number other than 0 at its start");
  }
  return true;
}

/// Checks the cycle of the command. Only a command computed from an image of this run can be
/// judged.
bool Commands::check_cycle(const command_t& command, const CommandContext& context) {
  if (command.cycle < 1) {
    return refuse({context, command, CommandRefusal::no_cycle},
                  "the command is computed from cycle " + std::to_string(command.cycle) +
                      ", which does not exist: a command repeats the cycle of the image from which "
                      "it was computed");
  }
  if (static_cast<std::uint64_t>(command.cycle) <= context.cycle + 1) return true;
  return refuse({context, command, CommandRefusal::future},
                "the command comes from the future: it is computed from cycle " +
                    std::to_string(command.cycle) + ", the present cycle is " +
                    std::to_string(context.cycle));
}

bool Commands::read_items(const command_t& command, const CommandContext& context) {
  items_.clear();
  for (std::size_t i = 0; i < command.signals.size(); ++i) {
    const std::int32_t position = command.signals[i];
    const auto index = static_cast<std::size_t>(position);
    if (position < 0 || index >= plan_.layout.signals.size() ||
        !plan_.layout.signals[index].output) {
      return refuse({context, command, CommandRefusal::bad_signal},
                    "signal " + std::to_string(position) + " is not an output of the layout");
    }
    const Signal& signal = plan_.layout.signals[index];
    if (!fits(signal.type, signal.bits, command.values[i])) {
      return refuse({context, command, CommandRefusal::bad_value, signal.node.value()},
                    "the value of " + signal_text(plan_, signal) + ", " +
                        std::to_string(command.values[i]) + ", does not fit its " +
                        std::to_string(signal.bits) + " bits");
    }
    const Freshness left = freshness_of(command, context.cycle, signal.fallback_cycles);
    if (!left.fresh) {
      return refuse({context, command, CommandRefusal::too_old, signal.node.value()},
                    too_old(command, context));
    }
    items_.push_back({static_cast<SignalIndex>(index), command.values[i], left.cycles, left.limit});
  }
  return !items_.empty();
}

Freshness Commands::freshness_of(const command_t& command, std::uint64_t now,
                                 std::uint32_t configured) const noexcept {
  return freshness({.computed_from = static_cast<std::uint64_t>(command.cycle),
                    .now = now,
                    .time_to_live = static_cast<std::uint32_t>(std::max(0, command.time_to_live)),
                    .configured = configured,
                    .most = second_});
}

std::uint32_t Commands::lease_cycles(std::size_t node_index) const noexcept {
  std::uint32_t longest = 0;
  for (const Item& item : items_) {
    if (plan_.layout.signals[item.signal].node_index != node_index) continue;
    if (item.cycles == 0) return 0;
    longest = std::max(longest, item.cycles);
  }
  return longest;
}

bool Commands::check_node(std::size_t node_index, const command_t& command,
                          const CommandContext& context) {
  const std::uint8_t node = plan_.nodes[node_index].id.value();
  const NodeStatus& status = context.nodes[node_index];
  if (plan_.nodes[node_index].boot && status.boot != BootState::ready) {
    return refuse({context, command, CommandRefusal::not_ready, node},
                  "the node has not booted yet");
  }
  if (status.nmt != NmtState::operational) {
    return refuse({context, command, CommandRefusal::not_ready, node},
                  "the node is not operational");
  }
  const Sender sender{.instance = command.instance, .name = command.sender};
  const LeaseTerm term{.now = context.cycle,
                       .cycles = lease_cycles(node_index),
                       .computed_from = static_cast<std::uint64_t>(command.cycle)};
  switch (leases_.take(node_index, sender, term)) {
    case LeaseVerdict::taken:
      return true;
    case LeaseVerdict::held:
      return refuse({context, command, CommandRefusal::held, node},
                    owned_text(node_index, command, context));
    case LeaseVerdict::overtaken:
      return refuse({context, command, CommandRefusal::overtaken, node}, overtaken(command));
    case LeaseVerdict::released:
      return refuse({context, command, CommandRefusal::overtaken, node}, after_release(command));
  }
  return false;
}

std::string Commands::owned_text(std::size_t node_index, const command_t& command,
                                 const CommandContext& context) const {
  const std::string holder{leases_.holder(node_index, context.cycle)};
  const std::string who = holder == command.sender
                              ? "another program of the same name, '" + holder + "',"
                              : "'" + holder + "'";
  return "the outputs of the node belong to " + who +
         " until this sender releases them or the time to live of its commands has expired";
}

/// Returns the shortest configured time to live of the node's outputs; 0 means no limit.
std::uint32_t Commands::shortest_limit(std::size_t node) const noexcept {
  std::uint32_t shortest = 0;
  for (std::size_t i = plan_.layout.inputs; i < plan_.layout.signals.size(); ++i) {
    const Signal& signal = plan_.layout.signals[i];
    if (signal.node_index != node || signal.fallback_cycles == 0) continue;
    shortest = shortest == 0 ? signal.fallback_cycles : std::min(shortest, signal.fallback_cycles);
  }
  return shortest;
}

/// A release is judged like a command: a copy of an old one must not stop the axes.
bool Commands::release_node(std::size_t node, const command_t& command,
                            const CommandContext& context) {
  if (!leases_.holds(node, command.instance, context.cycle)) return false;
  const std::uint8_t id = plan_.nodes[node].id.value();
  if (!freshness_of(command, context.cycle, shortest_limit(node)).fresh) {
    return refuse({context, command, CommandRefusal::too_old, id}, too_old(command, context));
  }
  const auto computed_from = static_cast<std::uint64_t>(command.cycle);
  if (!leases_.release(node, context.cycle, computed_from)) {
    return refuse({context, command, CommandRefusal::overtaken, id}, overtaken(command));
  }
  for (std::size_t i = plan_.layout.inputs; i < plan_.layout.signals.size(); ++i) {
    if (plan_.layout.signals[i].node_index != node) continue;
    set_output_(static_cast<SignalIndex>(i), 0, output_released);
  }
  return true;
}

bool Commands::release(const command_t& command, const CommandContext& context) {
  std::string nodes;
  for (std::size_t node = 0; node < plan_.nodes.size(); ++node) {
    if (context.only_node.value_or(node) != node) continue;
    if (!release_node(node, command, context)) continue;
    nodes += (nodes.empty() ? "" : ", ") + plan_.nodes[node].name;
  }
  if (nodes.empty()) return false;
  ++taken_;
  announce_({.when = context.now,
             .cycle = context.cycle,
             .node = 0,
             .kind = "outputs_released",
             .weight = Weight::note,
             .text = "'" + command.sender + "' has released the outputs of " + nodes});
  return true;
}

std::optional<CommandLimit> Commands::newest_limit(std::int64_t signal) const noexcept {
  const auto index = static_cast<std::size_t>(signal);
  return index < limits_.size() ? limits_[index] : std::nullopt;
}

bool Commands::take(const command_t& command, const CommandContext& context) {
  if (!check_message(command, context)) return false;
  if (!check_cycle(command, context)) return false;
  if (command.release != 0) return release(command, context);
  if (!read_items(command, context)) return false;
  std::ranges::fill(verdicts_, Verdict::unknown);
  bool any = false;
  for (const Item& item : items_) {
    const std::size_t node = plan_.layout.signals[item.signal].node_index;
    if (node >= context.nodes.size()) continue;
    if (verdicts_[node] == Verdict::unknown) {
      verdicts_[node] = check_node(node, command, context) ? Verdict::accepted : Verdict::refused;
    }
    if (verdicts_[node] == Verdict::refused) continue;
    set_output_(item.signal, item.value, item.cycles);
    limits_[item.signal] = item.limit;
    any = true;
  }
  if (any) ++taken_;
  return any;
}

}  // namespace takt
