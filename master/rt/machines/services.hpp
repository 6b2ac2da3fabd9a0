#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event.hpp"
#include "master/core/kept_state.hpp"
#include "master/core/machine.hpp"
#include "master/core/network/network.hpp"
#include "master/core/node_status.hpp"
#include "master/core/request.hpp"

namespace takt {

/// What the loop needs to know of a node in order to exchange PDOs with it.
template <class S>
concept NodeServices = requires(const S services, std::size_t node_index) {
  { services.nodes() } noexcept -> std::same_as<std::span<const NodeStatus>>;
  { services.exchanges_pdos(node_index) } noexcept -> std::same_as<bool>;
  { services.starts(node_index) } noexcept -> std::same_as<bool>;
  { services.boot_refused(node_index) } noexcept -> std::same_as<bool>;
  { services.limits_read(node_index) } noexcept -> std::same_as<std::span<const LimitReading>>;
};

/// Service frames: requests and their replies, and the number of answers that are still
/// outstanding.
template <class S>
concept RequestServices =
    Machine<S> && requires(S services, const S constant, const Request& request, Reply& reply,
                           std::uint8_t node, ObjectKey object, std::uint64_t id, Time time) {
      { services.submit(request, time) } noexcept -> std::same_as<bool>;
      { services.take(reply) } noexcept -> std::same_as<bool>;
      { services.withdraw(id) } noexcept;
      { constant.writes(node, object) } noexcept -> std::same_as<bool>;
      { constant.streams() } noexcept -> std::same_as<bool>;
      { constant.awaited_sub_blocks() } noexcept -> std::same_as<std::size_t>;
      { constant.awaited_answers() } noexcept -> std::same_as<std::size_t>;
      { services.on_absence(time) } noexcept;
    };

/// The loss of a node or of SYNC, and the commands that stop axes. This concept lets the compiler
/// report a function that is missing or was renamed, because the axes would not stop without it.
template <class S>
concept StopServices =
    requires(S services, const S constant, std::size_t node_index, Time now, NmtCommand last) {
      { constant.stops_drives() } noexcept -> std::same_as<bool>;
      { constant.demands_quick_stop(node_index) } noexcept -> std::same_as<bool>;
      { services.on_sync_loss() } noexcept;
      { services.on_sync_back() } noexcept;
      { constant.own_state() } noexcept -> std::same_as<NmtState>;
      { services.take_sync_restart() } noexcept -> std::same_as<bool>;
      { constant.awaits_axes() } noexcept -> std::same_as<std::optional<std::uint8_t>>;
      { services.axes_at_rest(AxesAtRest::confirmed) } noexcept;
      { services.every_axis_at_rest(AxesAtRest::confirmed) } noexcept;
      { services.drop_awaiting() } noexcept;
      { services.give_up_boots(now) } noexcept;
      { services.begin_stop(now, last) } noexcept;
      { constant.stopped() } noexcept -> std::same_as<bool>;
    };

/// State that a checkpoint holds, so that a replay can begin in the middle of a run.
template <class S>
concept KeptServices = requires(S services, const S constant, StateSize& size, StateWriter& writer,
                                StateReader& reader) {
  { constant.idle() } noexcept -> std::same_as<bool>;
  { services.keep(size) } noexcept;
  { services.keep(writer) } noexcept;
  { services.keep(reader) } noexcept;
};

/// All that the bus loop needs of the services of a bus: boot, SDO, NMT, heartbeat, LSS. `Network`
/// fulfils this concept and describes what each function does; the tests of the loop have simple
/// classes for it.
template <class S>
concept Services = std::constructible_from<S, const BusPlan&, NetworkOptions> && NodeServices<S> &&
                   RequestServices<S> && StopServices<S> && KeptServices<S> &&
                   requires(S services, const S constant, Event& event, Time now) {
                     { services.start(now) } noexcept;
                     { services.take(event) } noexcept -> std::same_as<bool>;
                     { constant.events_lost() } noexcept -> std::same_as<std::uint64_t>;
                   };
static_assert(Services<Network>);

}  // namespace takt
