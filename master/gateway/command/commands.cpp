#include "master/gateway/command/commands.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

#include "master/core/set_point.hpp"
#include "master/lcm/messages.hpp"
#include "master/units/units.hpp"

namespace takt {
namespace {

constexpr std::array<std::string_view, command_refusals> refusal_names{
    "observing", "schema",  "session",   "sender", "no_cycle", "future",   "bad_signal",
    "bad_value", "too_old", "not_ready", "held",   "waited",   "overtaken"};

std::uint32_t whole_cycles(Time span, Time period) noexcept {
  if (period <= Time{0}) return 1;
  return static_cast<std::uint32_t>(std::max<std::int64_t>(1, span / period));
}

std::string too_old(const command_t& command, const CommandContext& context) {
  return fmt::format(
      "the command is too old: it was computed from cycle {}, the present cycle is {}",
      command.cycle, context.cycle);
}

std::string overtaken(const command_t& command) {
  return "the command is older than the newest command to the node: it was computed from cycle " +
         std::to_string(command.cycle);
}

std::string after_release(const command_t& command) {
  return "the command is not newer than the release of its sender: both are computed from cycle " +
         std::to_string(command.cycle);
}

Sender sender_of(const command_t& command) {
  return {.instance = command.instance, .name = command.sender};
}

LeaseTerm term_of(const command_t& command, const CommandContext& context,
                  std::uint32_t cycles = 0) {
  return {.now = context.cycle,
          .cycles = cycles,
          .computed_from = static_cast<std::uint64_t>(command.cycle)};
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
      second_{whole_cycles(std::chrono::seconds{1}, plan.cycle.period)},
      leases_{plan.nodes.size(), second_},
      verdicts_(plan.nodes.size()),
      limits_(plan.layout.signals.size()) {}

std::string_view name(CommandRefusal refusal) noexcept {
  return refusal_names[std::to_underlying(refusal)];
}

bool Commands::refuse(const Received& from, const Refused& refused, const std::string& why) {
  const auto& [reason, node] = refused;
  count(reason);
  const std::string sender = shown(from.command.sender);
  const auto kept_back =
      reported_.allow(fmt::format("{}/{}/{:.24}", sender, node, why), from.context.now);
  if (!kept_back) return false;
  std::string text = fmt::format("command of '{}' refused", sender);
  if (node != 0) text += fmt::format(" for node {} ({})", node, node_name(plan_, node));
  text = with_kept_back(fmt::format("{}: {}", text, why), *kept_back);
  announce_({.when = from.context.now,
             .cycle = from.context.cycle,
             .node = node,
             .kind = "command_refused",
             .weight = Weight::warning,
             .text = std::move(text)});
  return false;
}

bool Commands::check_message(const Received& from) {
  if (options_.observe) {
    return refuse(from, {CommandRefusal::observing}, "taktd only observes (--observe)");
  }
  if (from.command.schema != message_schema) {
    return refuse(from, {CommandRefusal::schema}, schema_refusal(from.command.schema));
  }
  if (from.command.session != options_.session) {
    return refuse(from, {CommandRefusal::session},
                  "the command is for another session of taktd (a replayed log, or taktd has "
                  "restarted); use the session of the newest image_t");
  }
  if (from.command.sender.empty() || from.command.sender.size() > longest_sender ||
      std::ranges::any_of(from.command.sender, is_control)) {
    return refuse(from, {CommandRefusal::sender},
                  "the sender must have a name of 1 to 64 characters without control characters");
  }
  if (from.command.instance == 0) {
    return refuse(
        from, {CommandRefusal::sender},
        "the command has instance 0; a sender chooses a random number other than 0 at its start");
  }
  return true;
}

/// Checks the cycle of the command. The age is known only of a command that was computed from an
/// image of this run.
bool Commands::check_cycle(const Received& from) {
  if (from.command.cycle < 1) {
    return refuse(from, {CommandRefusal::no_cycle},
                  fmt::format("the command was computed from cycle {}, which does not exist: a "
                              "command repeats the cycle of the image from which it was computed",
                              from.command.cycle));
  }
  if (static_cast<std::uint64_t>(from.command.cycle) <= from.context.cycle + 1) return true;
  return refuse(from, {CommandRefusal::future},
                fmt::format("the command is ahead of taktd: it was computed from cycle {}, the "
                            "present cycle is {}",
                            from.command.cycle, from.context.cycle));
}

bool Commands::read_items(const Received& from) {
  items_.clear();
  for (std::size_t i = 0; i < from.command.signals.size(); ++i) {
    const std::int32_t position = from.command.signals[i];
    const auto index = static_cast<std::size_t>(position);
    if (position < 0 || index >= plan_.layout.signals.size() ||
        !plan_.layout.signals[index].output) {
      return refuse(from, {CommandRefusal::bad_signal},
                    fmt::format("signal {} is not an output of the layout", position));
    }
    const Signal& signal = plan_.layout.signals[index];
    if (!fits(signal.type, signal.bits, from.command.values[i])) {
      return refuse(from, {CommandRefusal::bad_value, signal.node.value()},
                    fmt::format("the value of {}.{}, {}, does not fit its {} bits",
                                plan_.nodes[signal.node_index].name, signal.name,
                                from.command.values[i], signal.bits));
    }
    const Freshness left = freshness_of(from.command, from.context.cycle, signal.fallback_cycles);
    if (!left.fresh) {
      return refuse(from, {CommandRefusal::too_old, signal.node.value()},
                    too_old(from.command, from.context));
    }
    items_.push_back(
        {static_cast<SignalIndex>(index), from.command.values[i], left.cycles, left.limit});
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

std::optional<Commands::Objection> Commands::objection_to(std::size_t node_index,
                                                          const Received& from) const {
  const NodeStatus& status = from.context.nodes[node_index];
  if (plan_.nodes[node_index].boot && status.boot != BootState::ready) {
    return Objection{CommandRefusal::not_ready, "the node has not booted yet"};
  }
  if (status.nmt != NmtState::operational) {
    return Objection{CommandRefusal::not_ready, "the node is not operational"};
  }
  switch (
      leases_.verdict(node_index, sender_of(from.command), term_of(from.command, from.context))) {
    case LeaseVerdict::taken:
      break;
    case LeaseVerdict::held:
      return Objection{CommandRefusal::held, owned_text(node_index, from)};
    case LeaseVerdict::overtaken:
      return Objection{CommandRefusal::overtaken, overtaken(from.command)};
    case LeaseVerdict::released:
      return Objection{CommandRefusal::overtaken, after_release(from.command)};
  }
  return std::nullopt;
}

/// Returns an objection if a message that is no command of outputs is too old for this node.
std::optional<Commands::Objection> Commands::objection_of_age(std::size_t node_index,
                                                              const Received& from) const {
  if (freshness_of(from.command, from.context.cycle, shortest_limit(node_index)).fresh) return {};
  return Objection{CommandRefusal::too_old, too_old(from.command, from.context)};
}

bool Commands::refuse_node(std::size_t node_index, const Objection& objection,
                           const Received& from) {
  return refuse(from, {objection.reason, plan_.nodes[node_index].id.value()}, objection.why);
}

void Commands::take_node(std::size_t node_index, const LeaseTerm& term, const Received& from) {
  leases_.take(node_index, sender_of(from.command), term);
}

bool Commands::check_node(std::size_t node_index, std::uint32_t cycles, const Received& from) {
  if (const auto found = objection_to(node_index, from)) {
    return refuse_node(node_index, *found, from);
  }
  take_node(node_index, term_of(from.command, from.context, cycles), from);
  return true;
}

std::string Commands::owned_text(std::size_t node_index, const Received& from) const {
  const std::string_view holder = leases_.holder(node_index, from.context.cycle);
  const bool same_name = holder == from.command.sender;
  return fmt::format(
      "the outputs of the node belong to {}'{}'{} until this sender releases them or the time to "
      "live of its commands has expired",
      same_name ? "another program of the same name, " : "", holder, same_name ? "," : "");
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

/// A release has to pass the same checks as a command, because a copy of an old release must not
/// stop the axes.
bool Commands::release_node(std::size_t node, const Received& from) {
  if (!leases_.holds(node, from.command.instance, from.context.cycle)) return false;
  const std::uint8_t id = plan_.nodes[node].id.value();
  if (!freshness_of(from.command, from.context.cycle, shortest_limit(node)).fresh) {
    return refuse(from, {CommandRefusal::too_old, id}, too_old(from.command, from.context));
  }
  const auto computed_from = static_cast<std::uint64_t>(from.command.cycle);
  if (!leases_.release(node, from.context.cycle, computed_from)) {
    return refuse(from, {CommandRefusal::overtaken, id}, overtaken(from.command));
  }
  for (std::size_t i = plan_.layout.inputs; i < plan_.layout.signals.size(); ++i) {
    if (plan_.layout.signals[i].node_index != node) continue;
    set_output_(static_cast<SignalIndex>(i), 0, output_released);
  }
  return true;
}

bool Commands::release(const Received& from) {
  std::string nodes;
  for (std::size_t node = 0; node < plan_.nodes.size(); ++node) {
    if (from.context.only_node.value_or(node) != node) continue;
    if (!release_node(node, from)) continue;
    nodes += (nodes.empty() ? "" : ", ") + plan_.nodes[node].name;
  }
  if (nodes.empty()) return false;
  ++taken_;
  announce_({.when = from.context.now,
             .cycle = from.context.cycle,
             .node = 0,
             .kind = "outputs_released",
             .weight = Weight::note,
             .text = "'" + from.command.sender + "' has released the outputs of " + nodes});
  return true;
}

std::optional<CommandLimit> Commands::newest_limit(std::int64_t signal) const noexcept {
  const auto index = static_cast<std::size_t>(signal);
  return index < limits_.size() ? limits_[index] : std::nullopt;
}

bool Commands::admits(const command_t& header, const CommandContext& context) {
  const Received from{header, context};
  return check_message(from) && check_cycle(from);
}

bool Commands::admits_lease(const command_t& header, std::span<const std::size_t> nodes,
                            const CommandContext& context) {
  const Received from{header, context};
  for (const std::size_t node : nodes) {
    if (const auto found = objection_of_age(node, from)) return refuse_node(node, *found, from);
    if (const auto found = objection_to(node, from)) return refuse_node(node, *found, from);
  }
  return true;
}

bool Commands::lease(const command_t& header, std::span<const std::size_t> nodes,
                     std::uint32_t cycles, const CommandContext& context) {
  if (!admits_lease(header, nodes, context)) return false;
  const Received from{header, context};
  const LeaseTerm term = term_of(header, context, cycles);
  for (const std::size_t node : nodes) take_node(node, term, from);
  return true;
}

void Commands::renew(const command_t& header, std::span<const std::size_t> nodes,
                     std::uint32_t cycles, const CommandContext& context) {
  const Received from{header, context};
  LeaseTerm term = term_of(header, context, cycles);
  term.is_sign_of_life = true;
  for (const std::size_t node : nodes) {
    const bool refused = objection_of_age(node, from) || objection_to(node, from);
    if (!refused) take_node(node, term, from);
  }
}

bool Commands::admits_stop(const command_t& header, std::size_t node,
                           const CommandContext& context) {
  const Received from{header, context};
  if (const auto found = objection_of_age(node, from)) return refuse_node(node, *found, from);
  const bool free = leases_.holder(node, context.cycle).empty();
  if (free || leases_.holds(node, header.instance, context.cycle)) return true;
  return refuse_node(node, {CommandRefusal::held, owned_text(node, from)}, from);
}

bool Commands::take(const command_t& command, const CommandContext& context) {
  const Received from{command, context};
  if (!check_message(from)) return false;
  if (!check_cycle(from)) return false;
  if (command.release != 0) return release(from);
  if (!read_items(from)) return false;
  std::ranges::fill(verdicts_, Verdict::unknown);
  bool any = false;
  for (const Item& item : items_) {
    const std::size_t node = plan_.layout.signals[item.signal].node_index;
    if (node >= context.nodes.size()) continue;
    if (verdicts_[node] == Verdict::unknown) {
      verdicts_[node] =
          check_node(node, lease_cycles(node), from) ? Verdict::accepted : Verdict::refused;
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
