#include <array>
#include <fmt/format.h>
#include <string_view>

#include "master/explain/frame/frame_value_text.hpp"
#include "master/explain/frame/service_texts.hpp"
#include "master/wire/bytes.hpp"
#include "master/wire/lss.hpp"

namespace takt {
namespace {

constexpr std::array<std::string_view, 4> parts{"vendor id", "product code", "revision",
                                                "serial number"};
constexpr std::array<std::string_view, 6> limits{"vendor id",   "product code", "revision from",
                                                 "revision to", "serial from",  "serial to"};

std::string_view part_name(std::uint8_t part) {
  return part < parts.size() ? parts[part] : std::string_view{"unknown part"};
}

std::uint32_t word(const Frame& frame) {
  return load_le<std::uint32_t>(std::span{frame.data}.subspan(1));
}

std::string_view error_text(lss::Service service, std::uint8_t error) {
  if (service == lss::Service::configure_node_id && error == 1) return "the id is out of range";
  if (service == lss::Service::configure_bit_timing && error == 1) {
    return "the device does not have this bit rate";
  }
  if (service == lss::Service::store && error == 1) return "the device can't store settings";
  if (service == lss::Service::store && error == 2) return "the memory can't be written";
  return "a reserved error code";
}

std::string result(const char* what, lss::Service service, const Frame& frame) {
  const std::uint8_t error = frame.data[1];
  if (error == 0) return fmt::format("{}: done", what);
  if (error == 255) return fmt::format("{}: refused, device error {}", what, frame.data[2]);
  return fmt::format("{}: refused, {} (error {})", what, error_text(service, error), error);
}

std::string node_id_text(std::uint8_t id) {
  return id == lss::no_node_id ? "none (255)" : fmt::format("{}", id);
}

std::string bit_rate_text(std::uint8_t table, std::uint8_t entry) {
  const std::string where = fmt::format("table {}, entry {}", table, entry);
  if (table != 0) return where;
  if (entry == lss::automatic_bit_rate) return "found by the device itself (" + where + ")";
  const unsigned kbit = entry < lss::bit_rates.size() ? lss::bit_rates[entry] : 0U;
  return kbit == 0 ? where + ", reserved" : fmt::format("{} kbit/s ({})", kbit, where);
}

std::string configure_text(lss::Service service, const Frame& frame, bool of_master) {
  if (service == lss::Service::configure_node_id) {
    return of_master ? "node id := " + node_id_text(frame.data[1])
                     : result("node id", service, frame);
  }
  if (service == lss::Service::configure_bit_timing) {
    return of_master ? "bit rate := " + bit_rate_text(frame.data[1], frame.data[2])
                     : result("bit rate", service, frame);
  }
  return of_master ? "store configuration" : result("store configuration", service, frame);
}

std::string switch_text(std::uint8_t mode) {
  if (mode > 1) return fmt::format("all devices to unknown mode {}", mode);
  return mode == 0 ? "all devices to waiting state" : "all devices to configuration state";
}

std::string activate_text(const Frame& frame) {
  const unsigned delay = word(frame) & 0xFFFF;
  return fmt::format("activate the bit rate after {} ms of silence, send again after {} ms", delay,
                     2 * delay);
}

std::string inquire_text(std::uint8_t code, const Frame& frame, bool of_master) {
  const std::string_view name = parts[code - 0x5A];
  return of_master ? fmt::format("inquire {}", name)
                   : fmt::format("{} is 0x{:08X}", name, word(frame));
}

/// Describes a question of the fast scan, which asks the devices whether the upper bits of a part
/// of their LSS address have a certain value.
std::string fast_scan_text(const Frame& frame) {
  const std::uint8_t bit = frame.data[5];
  if (bit == lss::FastScan::everybody) return "fastscan: which device has no node id?";
  const std::uint8_t part = frame.data[6];
  const std::uint8_t next = frame.data[7];
  if (bit > 31) return fmt::format("fastscan with unknown bit number {}", bit);
  std::string text =
      fmt::format("fastscan: {} 0x{:08X} in bits 31 to {}?", part_name(part), word(frame), bit);
  if (bit != 0 || next == part) return text;
  return text + (next < part ? " then to configuration" : fmt::format(" then {}", part_name(next)));
}

std::string of_master(const Frame& frame) {
  const std::uint8_t code = frame.data[0];
  const auto service = static_cast<lss::Service>(code);
  if (code >= 0x40 && code <= 0x43) {
    return fmt::format("select {} 0x{:08X}", parts[code - 0x40], word(frame));
  }
  if (code >= 0x46 && code <= 0x4B) {
    return fmt::format("identify {} 0x{:08X}", limits[code - 0x46], word(frame));
  }
  if (code >= 0x5A && code <= 0x5D) return inquire_text(code, frame, true);
  if (service == lss::Service::switch_global) return switch_text(frame.data[1]);
  if (service == lss::Service::activate_bit_timing) return activate_text(frame);
  if (service == lss::Service::identify_unconfigured) return "which device has no node id?";
  if (service == lss::Service::fast_scan) return fast_scan_text(frame);
  if (service == lss::Service::inquire_node_id) return "inquire node id";
  if (code == 0x11 || code == 0x13 || code == 0x17) return configure_text(service, frame, true);
  return fmt::format("unknown command 0x{:02X}", code);
}

std::string of_device(const Frame& frame) {
  const std::uint8_t code = frame.data[0];
  const auto service = static_cast<lss::Service>(code);
  if (code >= 0x5A && code <= 0x5D) return inquire_text(code, frame, false);
  if (service == lss::Service::selected) return "selected";
  if (service == lss::Service::identified) return "a device answers (identify or fastscan)";
  if (service == lss::Service::unconfigured) return "a device without node id answers";
  if (service == lss::Service::inquire_node_id) {
    return "node id is " + node_id_text(frame.data[1]);
  }
  if (code == 0x11 || code == 0x13 || code == 0x17) return configure_text(service, frame, false);
  return fmt::format("unknown answer 0x{:02X}", code);
}

}  // namespace

std::string lss_text(const Frame& frame, bool from_master) {
  if (frame.rtr) return "remote request";
  if (frame.length != 8) {
    return fmt::format("has {} bytes instead of 8: {}", frame.length, bytes_text(frame.payload()));
  }
  return from_master ? of_master(frame) : of_device(frame);
}

}  // namespace takt
