#include <array>
#include <initializer_list>

#include "eds_parser/check/rules.hpp"

namespace takt {
namespace {

struct Needed {
  std::uint16_t index;
  std::string_view name;
};

void need(const ObjectDictionary& dictionary, std::string_view who,
          std::initializer_list<Needed> objects, Report& report) {
  for (const auto& object : objects) {
    if (dictionary.find(object.index) != nullptr) continue;
    report.warning({}, who == "CiA 301" ? "mandatory-object-missing" : "profile-object-missing",
                   std::string{who} + " demands object " + hex(object.index) + " " +
                       std::string{object.name} + "; the file does not describe it");
  }
}

/// Device type bits 16..19 of CiA 401: which kinds of channels there are.
void check_401(const ObjectDictionary& dictionary, std::uint32_t device_type, Report& report) {
  struct Kind {
    std::uint32_t bit;
    std::initializer_list<std::uint16_t> any_of;
    Needed usual;
  };
  const std::array<Kind, 4> kinds = {{
      {16, {0x6000, 0x6020, 0x6100, 0x6120}, {0x6000, "read input 8-bit"}},
      {17, {0x6200, 0x6220, 0x6300, 0x6320}, {0x6200, "write output 8-bit"}},
      {18, {0x6400, 0x6401, 0x6402, 0x6403, 0x6404}, {0x6401, "read analogue input"}},
      {19, {0x6410, 0x6411, 0x6412, 0x6413, 0x6414}, {0x6411, "write analogue output"}},
  }};
  for (const auto& kind : kinds) {
    if ((device_type >> kind.bit & 1) == 0) continue;
    bool found = false;
    for (const auto index : kind.any_of) found = found || dictionary.find(index) != nullptr;
    if (!found) need(dictionary, "CiA 401", {kind.usual}, report);
  }
}

void tell_different(const ObjectDictionary& dictionary, std::uint8_t sub, std::uint32_t said,
                    std::string_view key, Report& report) {
  const auto* entry = dictionary.find(ObjectKey{0x1018, sub});
  const auto value = number_of(dictionary, {0x1018, sub});
  if (entry == nullptr || !value || *value == 0 || said == 0 || *value == said) return;
  report.warning(entry->value_pos(), "identity-mismatch",
                 section_name({0x1018, sub}) + " says " +
                     hex(static_cast<std::uint32_t>(*value), 8) + ", " + std::string{key} +
                     " of [DeviceInfo] says " + hex(said, 8) +
                     "; neither can be trusted as the expected identity");
}

}  // namespace

void check_mandatory(const ObjectDictionary& dictionary, Report& report) {
  need(dictionary, "CiA 301",
       {{0x1000, "device type"}, {0x1001, "error register"}, {0x1018, "identity object"}}, report);
  const bool no_vendor = dictionary.find(std::uint16_t{0x1018}) != nullptr &&
                         dictionary.find(ObjectKey{0x1018, 1}) == nullptr;
  if (no_vendor) {
    report.warning(dictionary.find(std::uint16_t{0x1018})->pos, "mandatory-object-missing",
                   "CiA 301 demands the vendor id, 1018sub1; the file does not describe it");
  }
}

void check_identity(const ObjectDictionary& dictionary, Report& report) {
  const auto& device = dictionary.device;
  tell_different(dictionary, 1, device.vendor_number, "VendorNumber", report);
  tell_different(dictionary, 2, device.product_number, "ProductNumber", report);
  tell_different(dictionary, 3, device.revision_number, "RevisionNumber", report);
}

void check_profile(const ObjectDictionary& dictionary, Report& report) {
  const auto value = number_of(dictionary, {0x1000, 0});
  if (!value) return;
  const auto device_type = static_cast<std::uint32_t>(*value);
  const bool several_devices = (device_type >> 16) == 0xFFFF;
  if (several_devices) return;
  switch (device_type & 0xFFFF) {
    case 401:
      return check_401(dictionary, device_type, report);
    case 402:
      return need(dictionary, "CiA 402",
                  {{0x6040, "controlword"},
                   {0x6041, "statusword"},
                   {0x6060, "modes of operation"},
                   {0x6061, "modes of operation display"}},
                  report);
    case 406:
      return need(dictionary, "CiA 406",
                  {{0x6000, "operating parameters"},
                   {0x6004, "position value"},
                   {0x6500, "operating status"},
                   {0x6501, "single-turn resolution"}},
                  report);
    default:
      return;
  }
}

}  // namespace takt
