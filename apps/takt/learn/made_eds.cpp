#include "apps/takt/learn/made_eds.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <set>

#include "apps/takt/learn/device_files.hpp"
#include "apps/takt/learn/learned_pdos.hpp"
#include "eds_parser/dictionary/standard_types.hpp"
#include "eds_parser/ini/eds_lists.hpp"
#include "eds_parser/write/object_sections.hpp"

namespace takt::learn {
namespace {

struct DriveObject {
  std::uint16_t index;
  std::string_view name;
  bool is_signed;
};

/// Objects of CiA 402-2 that are usually mapped, for the first axis.
constexpr std::array<DriveObject, 24> drive_objects{{
    {0x6040, "Controlword", false},          {0x6041, "Statusword", false},
    {0x6060, "Modes of operation", true},    {0x6061, "Modes of operation display", true},
    {0x6062, "Position demand value", true}, {0x6063, "Position actual internal value", true},
    {0x6064, "Position actual value", true}, {0x606B, "Velocity demand value", true},
    {0x606C, "Velocity actual value", true}, {0x6071, "Target torque", true},
    {0x6074, "Torque demand", true},         {0x6077, "Torque actual value", true},
    {0x6078, "Current actual value", true},  {0x607A, "Target position", true},
    {0x607C, "Home offset", true},           {0x6081, "Profile velocity", false},
    {0x6083, "Profile acceleration", false}, {0x6084, "Profile deceleration", false},
    {0x60B0, "Position offset", true},       {0x60B1, "Velocity offset", true},
    {0x60B2, "Torque offset", true},         {0x60F4, "Following error actual value", true},
    {0x60FD, "Digital inputs", false},       {0x60FF, "Target velocity", true},
}};

/// Returns the object of the first axis that corresponds to an index, or null if the table does not
/// have it. The objects of the next axis are 0x800 higher.
const DriveObject* drive_object(std::uint16_t index) {
  if (index < 0x6000 || index >= 0xA000) return nullptr;
  const auto first_axis = static_cast<std::uint16_t>(0x6000 + (index - 0x6000) % 0x800);
  const auto* found = std::ranges::find(drive_objects, first_axis, &DriveObject::index);
  return found == drive_objects.end() ? nullptr : found;
}

bool is_signed_402(std::uint16_t index) {
  const DriveObject* object = drive_object(index);
  return object != nullptr && object->is_signed;
}

DataType integer_of(unsigned bits, bool sign) {
  using enum DataType;
  constexpr std::array unsigned_types{unsigned8,  unsigned16, unsigned24, unsigned32,
                                      unsigned40, unsigned48, unsigned56, unsigned64};
  constexpr std::array signed_types{integer8,  integer16, integer24, integer32,
                                    integer40, integer48, integer56, integer64};
  if (bits == 1) return boolean;
  if (bits == 0 || bits > 64 || bits % 8 != 0) return unknown;
  return (sign ? signed_types : unsigned_types)[bits / 8 - 1];
}

bool is_text(const std::vector<std::uint8_t>& bytes) {
  return std::ranges::all_of(bytes, [](std::uint8_t c) { return c >= 0x20 && c < 0x7F; });
}

SubObject described(std::uint8_t sub, DataType type, Access access, std::string name) {
  SubObject object;
  object.sub = sub;
  object.name = std::move(name);
  object.type = type;
  object.type_code = static_cast<std::uint16_t>(type);
  object.access = access;
  return object;
}

class EdsMaker {
 public:
  explicit EdsMaker(const LearnedNode& node) : values_{node.values()} {
    cia402_ = (identity_of(values_).device_type & 0xFFFFU) == 402;
    add_standard();
    if (node.heartbeats.median()) sub({0x1017, 0}, DataType::unsigned16, Access::rw);
    if (makes_sync()) {
      sub({0x1005, 0}, DataType::unsigned32, Access::rw);
      sub({0x1006, 0}, DataType::unsigned32, Access::rw);
    }
    for (const auto& [key, value] : values_) add_seen(key, value);
    for (const LearnedPdo& pdo : learned_pdos(values_)) add_pdo(pdo);
  }

  std::vector<Object> objects() {
    std::vector<Object> list;
    for (auto& [key, sub] : subs_) {
      if (list.empty() || list.back().index != key.index) {
        Object& object = list.emplace_back();
        object.index = key.index;
        object.name = object_name(key.index);
      }
      list.back().subs.push_back(sub);
    }
    for (Object& object : list) complete(object);
    return list;
  }
  /// Returns the data types that are mapped as dummies.
  const std::set<std::uint16_t>& dummies() const noexcept { return dummies_; }

 private:
  SubObject& sub(ObjectKey key, DataType type, Access access) {
    const auto [at, is_new] = subs_.try_emplace(key);
    SubObject& sub = at->second;
    if (is_new) {
      sub = described(key.sub, type, access,
                      key.sub == 0 ? object_name(key.index) : fmt::format("Entry {}", key.sub));
    }
    return sub;
  }

  std::string object_name(std::uint16_t index) const {
    const DriveObject* object = cia402_ ? drive_object(index) : nullptr;
    if (object == nullptr) return fmt::format("Object {:04X}", index);
    const int axis = (index - 0x6000) / 0x800;
    return axis == 0 ? std::string{object->name} : fmt::format("{} {}", object->name, axis + 1);
  }

  /// Returns true if bit 30 of 0x1005 is set. Such a device has a SYNC period (0x1006) that can be
  /// written, even if the recording does not show a write.
  bool makes_sync() const { return (values_.number({0x1005, 0}).value_or(0) >> 30U & 1U) != 0; }

  void add_standard() {
    sub({0x1000, 0}, DataType::unsigned32, Access::ro);
    sub({0x1001, 0}, DataType::unsigned8, Access::ro);
    for (std::uint8_t i = 0; i <= 4; ++i) {
      sub({0x1018, i}, i == 0 ? DataType::unsigned8 : DataType::unsigned32, Access::ro);
    }
  }

  DataType type_of(ObjectKey key, const LearnedValue& value) const {
    const DataType standard = standard_type(key);
    if (standard != DataType::unknown) return standard;
    const bool sign = cia402_ && is_signed_402(key.index);
    const DataType number = value.last.size() <= 8
                                ? integer_of(static_cast<unsigned>(value.last.size()) * 8, sign)
                                : DataType::unknown;
    if (number != DataType::unknown) return number;
    return is_text(value.last) ? DataType::visible_string : DataType::domain;
  }

  void add_seen(ObjectKey key, const LearnedValue& value) {
    const DataType type = type_of(key, value);
    SubObject& entry = sub(key, type, Access::ro);
    if (value.written) entry.access = Access::rw;
    if (type == DataType::visible_string) {
      entry.default_text.assign(value.first.begin(), value.first.end());
    } else if (type != DataType::domain) {
      LearnedValue seen = value;
      if (!is_pdo_parameter(key.index)) seen.last = value.first;
      entry.default_text = fmt::format("0x{:X}", seen.number().value_or(0));
    }
  }

  void add_pdo(const LearnedPdo& pdo) {
    const std::uint16_t communication = pdo.communication_index();
    const std::uint16_t mapping = pdo.mapping_index();
    const auto parameter = [&](ObjectKey key, std::string value) {
      SubObject& entry = sub(key, standard_type(key), Access::rw);
      entry.access = Access::rw;
      if (entry.default_text.empty()) entry.default_text = std::move(value);
    };
    parameter({communication, 1}, "0x80000000");
    parameter({communication, 2}, "0xFF");
    parameter({mapping, 0}, "0");
    if (!pdo.mapping) {
      sub({communication, 1}, DataType::unsigned32, Access::rw).default_text = "0x80000000";
      return;
    }
    for (std::size_t i = 0; i < pdo.mapping->size(); ++i) {
      parameter({mapping, static_cast<std::uint8_t>(i + 1)}, "0");
      add_mapped((*pdo.mapping)[i], pdo.is_tpdo);
    }
  }

  void add_mapped(std::uint32_t entry, bool is_tpdo) {
    const ObjectKey key = mapped_object(entry);
    if (key.index < 0x20) {
      dummies_.insert(key.index);
      return;
    }
    const bool sign = cia402_ && is_signed_402(key.index);
    SubObject& mapped =
        sub(key, integer_of(entry & 0xFFU, sign), is_tpdo ? Access::ro : Access::rw);
    if (mapped.type == DataType::unknown) mapped.type_code = 0x0F;
    mapped.pdo_mappable = true;
    if (!is_tpdo) mapped.access = Access::rw;
  }

  /// Sets the type of an object. A record needs sub-index 0, which holds its highest sub-index.
  static void complete(Object& object) {
    const bool single = object.subs.size() == 1 && object.subs.front().sub == 0 &&
                        standard_type({object.index, 1}) == DataType::unknown;
    if (single) {
      object.type = ObjectType::var;
      return;
    }
    object.type = ObjectType::record;
    if (object.subs.front().sub != 0) {
      object.subs.insert(object.subs.begin(),
                         described(0, DataType::unsigned8, Access::ro, "Highest sub-index"));
    }
    SubObject& first = object.subs.front();
    if (first.default_text.empty()) first.default_text = std::to_string(object.subs.back().sub);
  }

  LearnedValues values_;
  bool cia402_ = false;
  std::map<ObjectKey, SubObject> subs_;
  std::set<std::uint16_t> dummies_;
};

void add_list(std::string& text, std::string_view name, const std::vector<Object>& objects,
              bool (*belongs)(std::uint16_t)) {
  std::string lines;
  unsigned count = 0;
  for (const Object& object : objects) {
    if (belongs(object.index)) lines += fmt::format("{}=0x{:04X}\n", ++count, object.index);
  }
  text += fmt::format("\n[{}]\nSupportedObjects={}\n{}", name, count, lines);
}

bool is_manufacturer(std::uint16_t index) { return index >= 0x2000 && index < 0x6000; }
bool is_optional(std::uint16_t index) { return !is_mandatory(index) && !is_manufacturer(index); }

}  // namespace

std::string made_eds(const LearnedNode& node, const std::string& recording,
                     const std::string& file_name) {
  EdsMaker maker{node};
  const std::vector<Object> objects = maker.objects();
  const SeenIdentity identity = identity_of(node.values());
  const auto in = [&](std::uint16_t first) {
    return std::ranges::count_if(
        objects, [&](const Object& o) { return o.index >= first && o.index < first + 0x200; });
  };
  std::string text = fmt::format(
      "; Objects of node {} that a recording shows; the vendor's EDS has more.\n"
      "[FileInfo]\nFileName={}\nFileVersion=1\nFileRevision=0\nEDSVersion=4.0\n"
      "Description=made by takt learn from {}\n\n",
      node.id, file_name, recording);
  text += fmt::format(
      "[DeviceInfo]\nVendorName=\nVendorNumber=0x{:X}\nProductName=Node {}\nProductNumber=0x{:X}\n"
      "RevisionNumber=0x{:X}\nOrderCode=\nBaudRate_10=1\nBaudRate_20=1\nBaudRate_50=1\n"
      "BaudRate_125=1\nBaudRate_250=1\nBaudRate_500=1\nBaudRate_800=1\nBaudRate_1000=1\n"
      "SimpleBootUpMaster=0\nSimpleBootUpSlave=1\nGranularity=8\nDynamicChannelsSupported=0\n"
      "GroupMessaging=0\nNrOfRXPDO={}\nNrOfTXPDO={}\nLSS_Supported=0\n\n[DummyUsage]\n",
      identity.vendor_id, node.id, identity.product_code, identity.revision_number, in(0x1400),
      in(0x1800));
  for (std::uint16_t dummy = 1; dummy <= 7; ++dummy) {
    text += fmt::format("Dummy{:04X}={}\n", dummy, maker.dummies().contains(dummy) ? 1 : 0);
  }
  add_list(text, "MandatoryObjects", objects, is_mandatory);
  add_list(text, "OptionalObjects", objects, is_optional);
  add_list(text, "ManufacturerObjects", objects, is_manufacturer);
  for (const Object& object : objects) {
    for (const std::string& line : object_sections(object)) text += line + '\n';
  }
  return text;
}

}  // namespace takt::learn
