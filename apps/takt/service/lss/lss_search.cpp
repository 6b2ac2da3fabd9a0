// Verbs of `takt lss` that look for devices.
#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

#include "apps/takt/service/lss/lss_verbs.hpp"

namespace takt {
namespace {

int print_devices(const LssOptions& options, const std::vector<LssAddress>& devices) {
  nlohmann::json list = nlohmann::json::array();
  for (const LssAddress& device : devices) {
    list.push_back(device_json(device));
    if (!options.access.live.json) std::puts(device_text(device).c_str());
  }
  if (options.access.live.json) lss_print({{"devices", list}});
  return devices.empty() ? 1 : 0;
}

/// Returns true if every question of the scan was answered: each number that the user has not given
/// is then 0.
bool all_answered(const LssOptions& options, const LssAddress& found) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] != parse_unsigned(options.parts[i]).value_or(0)) return false;
  }
  return true;
}

/// Some devices also answer a scan in configuration state, and they answer every question.
constexpr const char* answers_everything =
    "the device that was found answers every further question, but only devices in waiting state "
    "should. There may be more devices: give this one a node id (takt lss set-id), then search "
    "again";

LssCommand slow_scan(std::uint32_t vendor, std::uint32_t product, LssRange revisions,
                     LssRange serials) {
  return {.op = LssOp::slow_scan,
          .numbers = {vendor, product, revisions.from, revisions.to, serials.from, serials.to}};
}

}  // namespace

int lss_find(const LssOptions& options) {
  LssAccess access{options.access};
  std::vector<LssAddress> devices;
  std::string trouble;
  while (trouble.empty() && devices.size() < 127) {
    const std::array<LssCommand, 2> scan{LssCommand{.op = LssOp::switch_global},
                                         fast_scan(options)};
    const LssResult result = access.run(std::span{scan}.subspan(devices.empty() ? 0 : 1)).back();
    if (result.outcome != LssOutcome::done) {
      if (devices.empty() || result.outcome == LssOutcome::lost) trouble = lss_failure_text(result);
      break;
    }
    if (std::ranges::find(devices, result.numbers) != devices.end()) break;
    if (!devices.empty() && all_answered(options, result.numbers)) {
      std::fprintf(stderr, "takt: note: %s\n", answers_everything);
      break;
    }
    devices.push_back(result.numbers);
    if (options.first) break;
  }
  access.run({.op = LssOp::switch_global});
  const int code = print_devices(options, devices);
  return trouble.empty() ? code : complain(trouble, 1);
}

int lss_scan(const LssOptions& options) {
  const auto revisions = lss_range(options.parts[2]);
  const auto serials = lss_range(options.parts[3]);
  const auto vendor = parse_unsigned(options.parts[0]);
  const auto product = parse_unsigned(options.parts[1]);
  if (!vendor || !product || !revisions || !serials) return complain("a number is missing", 2);
  LssAccess access{options.access};
  std::vector<LssAddress> devices;
  std::vector<std::pair<LssRange, LssRange>> ranges{{*revisions, *serials}};
  while (!ranges.empty() && devices.size() < 127) {
    const auto [in_revisions, in_serials] = ranges.back();
    ranges.pop_back();
    const LssResult result = access.run(slow_scan(*vendor, *product, in_revisions, in_serials));
    if (result.outcome == LssOutcome::nobody) continue;
    require_done(result);
    devices.push_back(result.numbers);
    const auto [own_vendor, own_product, revision, serial] = result.numbers;
    if (revision < in_revisions.to) ranges.push_back({{revision + 1, in_revisions.to}, *serials});
    if (serial < in_serials.to) {
      ranges.push_back({{revision, revision}, {serial + 1, in_serials.to}});
    }
  }
  print_devices(options, devices);
  if (devices.empty()) require_done({.op = LssOp::slow_scan, .outcome = LssOutcome::nobody});
  return 0;
}

}  // namespace takt
