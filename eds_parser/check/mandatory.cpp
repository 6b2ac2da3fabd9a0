#include <algorithm>

#include "eds_parser/check/rules.hpp"

namespace takt {
namespace {

struct Mandatory {
  std::uint16_t index;
  std::string_view name;
};

constexpr Mandatory mandatory[] = {
    {0x1000, "device type"}, {0x1001, "error register"}, {0x1018, "identity object"}};

/// Returns the place of the section after which a missing object belongs in the file, or the place
/// of the first section if no section comes before it.
SourcePos place_of(const ObjectDictionary& dictionary, std::uint16_t index) {
  if (dictionary.objects.empty()) return {};
  const auto behind = std::ranges::lower_bound(dictionary.objects, index, {}, &Object::index);
  return (behind == dictionary.objects.begin() ? behind : behind - 1)->pos;
}

void report_different(const ObjectDictionary& dictionary, std::uint8_t sub, std::uint32_t declared,
                      std::string_view key, Report& report) {
  const auto* entry = dictionary.find(ObjectKey{0x1018, sub});
  const auto value = unsigned_of(dictionary, {0x1018, sub});
  if (entry == nullptr || !value || *value == 0 || declared == 0 || *value == declared) return;
  report.warning(entry->value_pos(), "identity-mismatch", section_name({0x1018, sub}), " says ",
                 Hex{static_cast<std::uint32_t>(*value), 8}, ", ", key, " of [DeviceInfo] says ",
                 Hex{declared, 8}, "; neither can be trusted as the expected identity");
}

}  // namespace

void check_mandatory(const ObjectDictionary& dictionary, Report& report) {
  for (const auto& object : mandatory) {
    if (dictionary.find(object.index) != nullptr) continue;
    report.warning(place_of(dictionary, object.index), "mandatory-object-missing",
                   "CiA 301 requires object ", Hex{object.index}, ' ', object.name,
                   "; the file does not describe it");
  }
  const bool no_vendor = dictionary.find(std::uint16_t{0x1018}) != nullptr &&
                         dictionary.find(ObjectKey{0x1018, 1}) == nullptr;
  if (no_vendor) {
    report.warning(dictionary.find(std::uint16_t{0x1018})->pos, "mandatory-object-missing",
                   "CiA 301 requires the vendor id, 1018sub1; the file does not describe it");
  }
}

void check_identity(const ObjectDictionary& dictionary, Report& report) {
  const auto& device = dictionary.device;
  report_different(dictionary, 1, device.vendor_number, "VendorNumber", report);
  report_different(dictionary, 2, device.product_number, "ProductNumber", report);
  report_different(dictionary, 3, device.revision_number, "RevisionNumber", report);
}

}  // namespace takt
