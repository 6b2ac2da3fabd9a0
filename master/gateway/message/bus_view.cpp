#include "master/gateway/message/bus_view.hpp"

#include <algorithm>
#include <utility>

#include "master/lcm/channel_names.hpp"

namespace takt {
namespace {

constexpr std::size_t most_events = 50;
constexpr std::size_t most_buses = 64;
constexpr std::size_t most_signals = 65536;

/// Appends the list of a message to the `parts` that came before it, and moves them to `whole` with
/// the last part. All parts of a message have the same `key`. If a part is missing, all parts are
/// dropped.
template <class T, class List, class Count>
void join(const T& part, std::optional<T>& parts, std::optional<T>& whole, std::int64_t T::* key,
          List T::* list, Count T::* count) {
  if (part.part == 0) {
    parts = part;
  } else if (!parts || (*parts).*key != part.*key || part.part != parts->part + 1) {
    return parts.reset();
  } else if (((*parts).*list).size() > most_signals) {
    return parts.reset();
  } else {
    List& joined = (*parts).*list;
    joined.insert(joined.end(), (part.*list).begin(), (part.*list).end());
    parts->part = part.part;
    (*parts).*count = static_cast<Count>(joined.size());
  }
  if (part.part + 1 == part.parts) whole = std::exchange(parts, std::nullopt);
}

}  // namespace

void BusView::new_session(std::int64_t session) {
  if (session == session_) return;
  two_daemons_ = session_ != 0 && session == earlier_session_;
  earlier_session_ = session_;
  session_ = session;
  status_parts_.reset();
  pdo_parts_.reset();
  motions_.reset();
  motion_parts_.reset();
  speed_axes_.reset();
  speed_parts_.reset();
  layout_parts_.clear();
  signals_.clear();
  values_.clear();
  layout_hash_ = 0;
}

/// Only status_t and layout_t, which are sent periodically, begin another session. A single other
/// message from another session, forged or late, must not discard the state of this one.
bool BusView::is_of_this_session(std::int64_t session) {
  if (session_ == 0) new_session(session);
  return session == session_;
}

void BusView::take(const status_t& status) {
  new_session(status.session);
  join(status, status_parts_, status_, &status_t::cycle, &status_t::nodes, &status_t::num_nodes);
}

void BusView::take(const pdo_status_t& pdos) {
  if (is_of_this_session(pdos.session)) {
    join(pdos, pdo_parts_, pdos_, &pdo_status_t::cycle, &pdo_status_t::pdos,
         &pdo_status_t::num_pdos);
  }
}

void BusView::take(const sync_status_t& sync) {
  if (!is_of_this_session(sync.session)) return;
  sync_ = sync;
}

void BusView::take(const motion_t& motions) {
  if (!is_of_this_session(motions.session)) return;
  join(motions, motion_parts_, motions_, &motion_t::cycle, &motion_t::axes, &motion_t::num_axes);
}

void BusView::take(const speed_axes_t& axes) {
  if (!is_of_this_session(axes.session)) return;
  join(axes, speed_parts_, speed_axes_, &speed_axes_t::layout_hash, &speed_axes_t::axes,
       &speed_axes_t::num_axes);
}

std::span<const speed_axis_t> BusView::speed_axes() const noexcept {
  if (!speed_axes_ || signals_.empty() || speed_axes_->layout_hash != layout_hash_) return {};
  return speed_axes_->axes;
}

void BusView::take(const layout_t& layout) {
  new_session(layout.session);
  if (layout.hash == layout_hash_ && !signals_.empty()) return;
  if (layout.total_signals < 0) return;
  if (static_cast<std::size_t>(layout.total_signals) > most_signals) return;
  for (std::size_t i = 0; i < layout.signals.size(); ++i) {
    const std::int32_t at = layout.first_signal + static_cast<std::int32_t>(i);
    if (layout.first_signal < 0 || at >= layout.total_signals) return;
    layout_parts_.insert_or_assign(at, layout.signals[i]);
  }
  if (layout_parts_.size() != static_cast<std::size_t>(layout.total_signals)) return;
  layout_hash_ = layout.hash;
  finish_layout();
}

void BusView::finish_layout() {
  std::vector<ValueFormat> formats;
  signals_.clear();
  for (auto& [position, signal] : layout_parts_) {
    formats.push_back({.type = static_cast<DataType>(signal.data_type),
                       .bits = static_cast<std::uint8_t>(std::clamp<int>(signal.bits, 0, 64)),
                       .scale = signal.scale,
                       .offset = signal.offset});
    signals_.push_back(std::move(signal));
  }
  layout_parts_.clear();
  units_ = Units{formats};
  values_.clear();
  next_values_.assign(signals_.size(), 0);
  next_stale_.assign(signals_.size(), false);
}

void BusView::take(const image_t& image) {
  if (!is_of_this_session(image.session)) return;
  if (signals_.empty() || image.layout_hash != layout_hash_) return;
  if (image.part == 0) {
    next_part_ = 0;
    next_cycle_ = image.cycle;
    next_stale_.assign(next_stale_.size(), false);
  }
  const auto first = static_cast<std::size_t>(image.first_signal);
  if (image.part != next_part_ || image.cycle != next_cycle_ || image.first_signal < 0 ||
      first + image.values.size() > next_values_.size()) {
    return;
  }
  std::ranges::copy(image.values, next_values_.begin() + image.first_signal);
  for (const std::int32_t signal : image.stale) {
    const auto at = static_cast<std::size_t>(signal);
    if (signal >= 0 && at < next_stale_.size()) next_stale_[at] = true;
  }
  ++next_part_;
  if (next_part_ != image.parts) return;
  values_ = next_values_;
  stale_ = next_stale_;
  cycle_ = image.cycle;
  ++images_;
}

void BusView::take(event_t event) {
  if (!is_of_this_session(event.session)) return;
  events_.push_back(std::move(event));
  if (events_.size() > most_events) events_.pop_front();
}

namespace {

template <class T>
std::string take_as(BusView& view, std::string_view channel, Bytes data) {
  auto message = decode<T>(data);
  if (!message) {
    const bool old = message.error() == DecodeFault::schema_1;
    return std::string{channel} + ": " +
           (old ? daemon_schema_text(1) : std::string{text(message.error())});
  }
  view.take(std::move(*message));
  return {};
}

}  // namespace

std::string BusViews::take(std::string_view channel, Bytes data) {
  struct Kind {
    std::string_view what;
    std::string (*take)(BusView&, std::string_view, Bytes);
  };
  static constexpr Kind kinds[] = {
      {"STATUS", take_as<status_t>},    {"LAYOUT", take_as<layout_t>},
      {"IMAGE", take_as<image_t>},      {"TIMING", take_as<timing_t>},
      {"PDOS", take_as<pdo_status_t>},  {"EVENT", take_as<event_t>},
      {"SYNC", take_as<sync_status_t>}, {"SPEED_AXES", take_as<speed_axes_t>},
      {"MOTION", take_as<motion_t>}};
  for (const Kind& kind : kinds) {
    const std::string_view bus = bus_of_channel(channel, kind.what);
    if (bus.empty()) continue;
    if (buses_.size() == most_buses && !buses_.contains(bus)) return {};
    return kind.take(buses_[std::string{bus}], channel, data);
  }
  return {};
}

}  // namespace takt
