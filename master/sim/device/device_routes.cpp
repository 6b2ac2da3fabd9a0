#include "master/sim/device/device.hpp"
#include "master/sim/dictionary/cob_rules.hpp"

// The identifiers that a device receives.

namespace takt::sim {

/// An SDO channel exists if bit 31 of both its COB-IDs is 0. CiA 301, 7.5.2.33.
void Device::route_sdo_servers() noexcept {
  for (std::uint16_t n = 0; n < sdo_.size(); ++n) {
    if (n != 0) {
      const auto index = static_cast<std::uint16_t>(0x1200u + n);
      const auto request = static_cast<std::uint32_t>(store_.number({index, 1}, cob_invalid));
      const auto answer = static_cast<std::uint32_t>(store_.number({index, 2}, cob_invalid));
      if (((request | answer) & cob_invalid) != 0 || request == 0 || answer == 0) continue;
      sdo_[n].set_channel(cob_id(request), cob_id(answer));
    }
    routes_.add({sdo_[n].request_id(), RouteKind::sdo, n});
  }
}

void Device::build_routes() noexcept {
  list_routes();
  routes_.sort();
  routes_changed_ = true;
}

void Device::list_routes() noexcept {
  routes_.clear();
  routes_.add({CobId::base(0), RouteKind::nmt, 0});
  if (lss_) routes_.add({LssSlave::id(), RouteKind::lss, 0});
  if (speaks_only_lss()) return;
  routes_.add({sync_.id(), RouteKind::sync, 0});
  if (const auto time = time_.id()) routes_.add({*time, RouteKind::time, 0});
  route_sdo_servers();
  routes_.add({guarding_.id(), RouteKind::guarding, 0});
  for (const auto& watch : watch_.watches()) {
    if (watch.node != 0) {
      routes_.add({CobId::base(0x700u + watch.node), RouteKind::heartbeat, 0});
    }
  }
  for (std::size_t i = 0; i < rpdos_.size(); ++i) {
    if (!rpdos_[i].record().valid()) continue;
    routes_.add({rpdos_[i].record().id(), RouteKind::rpdo, static_cast<std::uint16_t>(i)});
  }
  for (std::size_t i = 0; i < tpdos_.size(); ++i) {
    const PdoRecord& record = tpdos_[i].record();
    if (!record.valid() || !record.rtr_allowed()) continue;
    routes_.add({record.id(), RouteKind::tpdo_request, static_cast<std::uint16_t>(i)});
  }
}

}  // namespace takt::sim
