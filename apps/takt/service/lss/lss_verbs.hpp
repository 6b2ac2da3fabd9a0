#pragma once
#include <nlohmann/json_fwd.hpp>

#include "apps/takt/service/lss/lss_selection.hpp"

namespace takt {

// The verbs of `takt lss`. Each returns the exit code, or throws a Failure.

/// Finds devices without node-ID with Fastscan, one after the other. A found device stays in
/// configuration state until the end, so that it does not answer the next scan. Devices that were
/// left in configuration state before are first switched back to waiting state.
int lss_find(const LssOptions& options);
/// Finds all devices of a product. After each found device, it scans the higher serial numbers of
/// the same revision, then the higher revisions.
int lss_scan(const LssOptions& options);
/// Prints whether a device without node-ID answers.
int lss_unconfigured(const LssOptions& options);
/// Prints the address and the node-ID of one device.
int lss_inquire(const LssOptions& options);
int lss_set_id(const LssOptions& options);
int lss_set_bitrate(const LssOptions& options);
/// Lets the device store its settings.
int lss_store(const LssOptions& options);
/// Switches all devices to configuration state or to waiting state.
int lss_switch(const LssOptions& options);

/// Throws a Failure if the service did not succeed.
void require_done(const LssResult& result);
void lss_print(const nlohmann::json& json);

}  // namespace takt
