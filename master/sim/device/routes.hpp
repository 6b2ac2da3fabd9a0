#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "eds_parser/values/ids.hpp"

namespace takt::sim {

/// The service of a device that receives a frame. If several services have the same identifier,
/// they receive the frame in this order.
enum class RouteKind : std::uint8_t {
  nmt,
  sync,
  sdo,
  heartbeat,
  rpdo,
  tpdo_request,
  guarding,
  lss,
  time,
};

struct Route {
  CobId id;
  RouteKind kind = RouteKind::nmt;
  std::uint16_t index = 0;  ///< index of one of several SDO servers or PDOs
};

/// The identifiers that a device receives. An 11-bit identifier is found without a search, because
/// every frame of the bus asks for it. Allocates only in reserve().
class Routes {
 public:
  Routes() noexcept { first_.fill(nothing); }

  void reserve(std::size_t count) { routes_.reserve(count); }
  std::size_t capacity() const noexcept { return routes_.capacity(); }
  std::span<const Route> all() const noexcept { return routes_; }

  void clear() noexcept {
    for (const Route& route : routes_) {
      if (!route.id.is_extended()) first_[route.id.id()] = nothing;
    }
    routes_.clear();
  }
  /// Adds a route. After the last one, sort() must be called.
  void add(const Route& route) noexcept { routes_.push_back(route); }
  void sort() noexcept {
    // All keys differ, so an in-place sort, which allocates nothing, gives a definite order.
    std::ranges::sort(routes_, {},
                      [](const Route& r) { return std::tuple{r.id, r.kind, r.index}; });
    for (std::size_t i = routes_.size(); i-- != 0;) {
      if (!routes_[i].id.is_extended()) first_[routes_[i].id.id()] = static_cast<std::uint16_t>(i);
    }
  }

  /// Returns the routes with this identifier.
  std::span<const Route> of(CobId id) const noexcept {
    const std::size_t first = id.is_extended() ? find_extended(id) : first_[id.id()];
    if (first >= routes_.size()) return {};
    std::size_t end = first;
    while (end < routes_.size() && routes_[end].id == id) ++end;
    return {routes_.data() + first, end - first};
  }

 private:
  static constexpr std::uint16_t nothing = 0xFFFF;

  std::size_t find_extended(CobId id) const noexcept {
    return static_cast<std::size_t>(std::ranges::lower_bound(routes_, id, {}, &Route::id) -
                                    routes_.begin());
  }

  std::vector<Route> routes_;              ///< sorted by ascending identifier
  std::array<std::uint16_t, 2048> first_;  ///< 11-bit identifier -> its first route, or `nothing`
};

}  // namespace takt::sim
