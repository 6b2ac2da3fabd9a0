#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "eds_parser/check/rules.hpp"

namespace takt {
namespace {

struct Needed {
  std::uint16_t index;
  std::string_view name;
};

/// A kind of channels of a CiA 401 device, with its bit in the device type. A device with this bit
/// must have at least one of the objects `any_of`.
struct ChannelKind {
  unsigned bit;
  std::array<std::uint16_t, 5> any_of;
  Needed usual;
};

constexpr ChannelKind channel_kinds[] = {
    {16, {0x6000, 0x6020, 0x6100, 0x6120}, {0x6000, "read input 8-bit"}},
    {17, {0x6200, 0x6220, 0x6300, 0x6320}, {0x6200, "write output 8-bit"}},
    {18, {0x6401, 0x6400, 0x6402, 0x6403, 0x6404}, {0x6401, "read analogue input"}},
    {19, {0x6411, 0x6410, 0x6412, 0x6413, 0x6414}, {0x6411, "write analogue output"}},
};

constexpr Needed of_each_drive[] = {{0x6040, "controlword"},
                                    {0x6041, "statusword"},
                                    {0x6060, "modes of operation"},
                                    {0x6061, "modes of operation display"}};

/// The objects that every version of CiA 402 demands of a drive that has the mode. A mode is a bit
/// in 0x6502.
constexpr Needed of_pp[] = {{0x607A, "target position"},
                            {0x6064, "position actual value"},
                            {0x6081, "profile velocity"},
                            {0x6083, "profile acceleration"}};
constexpr Needed of_vl[] = {
    {0x6042, "vl target velocity"},       {0x6043, "vl velocity demand"},
    {0x6044, "vl velocity actual value"}, {0x6046, "vl velocity min max amount"},
    {0x6048, "vl velocity acceleration"}, {0x6049, "vl velocity deceleration"}};
constexpr Needed of_pv[] = {{0x60FF, "target velocity"}, {0x606C, "velocity actual value"}};
constexpr Needed of_tq[] = {{0x6071, "target torque"}};
constexpr Needed of_hm[] = {{0x6098, "homing method"}, {0x6099, "homing speeds"}};
constexpr Needed of_ip[] = {{0x60C1, "interpolation data record"}};
constexpr Needed of_csp[] = {{0x607A, "target position"}, {0x6064, "position actual value"}};
constexpr Needed of_csv[] = {{0x60FF, "target velocity"}, {0x606C, "velocity actual value"}};
constexpr Needed of_cst[] = {{0x6071, "target torque"}, {0x6077, "torque actual value"}};

struct Mode {
  unsigned bit;
  std::string_view name;
  std::span<const Needed> objects;
};

constexpr Mode modes[] = {{0, "pp", of_pp},   {1, "vl", of_vl},   {2, "pv", of_pv},
                          {3, "tq", of_tq},   {5, "hm", of_hm},   {6, "ip", of_ip},
                          {7, "csp", of_csp}, {8, "csv", of_csv}, {9, "cst", of_cst}};
constexpr std::uint64_t modes_of_a_cycle = 0x3C0;  // the modes ip, csp, csv, cst

/// The objects of encoders of both classes.
constexpr Needed of_each_encoder[] = {{0x6000, "operating parameters"},
                                      {0x6500, "operating status"},
                                      {0x6501, "single-turn resolution or measuring step"},
                                      {0x6503, "alarms"},
                                      {0x6504, "supported alarms"},
                                      {0x6507, "profile and software version"}};
constexpr std::uint32_t multi_turn = 2;
constexpr std::uint32_t multi_sensor = 10;

/// Checks one logical device against its profile. If a device has several modules, the indices of
/// this module are higher by `base` than in the profile.
class ProfileCheck {
 public:
  ProfileCheck(const ObjectDictionary& dictionary, std::uint16_t base, ObjectKey device_type,
               Report& report)
      : dictionary_{dictionary}, base_{base}, device_type_{device_type}, report_{report} {}

  void run() {
    const auto type =
        static_cast<std::uint32_t>(unsigned_of(dictionary_, device_type_).value_or(0));
    switch (type & 0xFFFF) {
      case 401:
        return check_io(type);
      case 402:
        return check_drive();
      case 406:
        return check_encoder(type >> 16);
      default:
        return;
    }
  }

 private:
  std::uint16_t index_of(std::uint16_t index) const noexcept {
    return static_cast<std::uint16_t>(index + base_);
  }
  bool has(std::uint16_t index) const noexcept {
    return dictionary_.find(index_of(index)) != nullptr;
  }
  SourcePos place(ObjectKey key) const { return dictionary_.find(key)->value_pos(); }
  std::string name_of(const Needed& object) const {
    return concat(Hex{index_of(object.index)}, ' ', object.name);
  }

  void need(std::string_view who, const Needed& object) {
    if (has(object.index)) return;
    report_.warning(place(device_type_), "profile-object-missing", who, " requires object ",
                    name_of(object), "; the file does not describe it");
  }

  void check_io(std::uint32_t type) {
    for (const auto& kind : channel_kinds) {
      if ((type >> kind.bit & 1) == 0) continue;
      const bool found = std::ranges::any_of(
          kind.any_of, [this](std::uint16_t index) { return index != 0 && has(index); });
      if (!found) need("CiA 401", kind.usual);
    }
  }

  void check_drive() {
    for (const auto& object : of_each_drive) need("CiA 402", object);
    const ObjectKey key{index_of(0x6502), 0};
    const auto claimed = unsigned_of(dictionary_, key);
    if (!has(0x6502)) {
      return advise(place(device_type_), {0x6502, "supported drive modes"},
                    "takt does not know the modes of the drive and does not check their objects");
    }
    if (!claimed) return;
    for (const auto& mode : modes) {
      if ((*claimed >> mode.bit & 1) != 0) need_for(mode, place(key));
    }
    if ((*claimed & modes_of_a_cycle) != 0 && !has(0x60C2)) {
      advise(place(key), {0x60C2, "interpolation time period"},
             "the drive can't receive the cycle time of its modes ip, csp, csv, cst");
    }
  }

  /// Reports each missing object of a mode. An object that several modes demand is reported only
  /// once.
  void need_for(const Mode& mode, SourcePos pos) {
    for (const auto& object : mode.objects) {
      if (has(object.index) || std::ranges::find(reported_, object.index) != reported_.end())
        continue;
      reported_.push_back(object.index);
      report_.warning(pos, "profile-object-missing", "CiA 402 requires object ", name_of(object),
                      " for the mode ", mode.name, ", which ", Hex{index_of(0x6502)},
                      " claims; the file does not describe it");
    }
  }

  void advise(SourcePos pos, const Needed& object, std::string_view why) {
    report_.note(pos, "profile-object-advised", "object ", name_of(object),
                 " is not described: ", why);
  }

  void check_encoder(std::uint32_t kind) {
    for (const auto& object : of_each_encoder) need("CiA 406", object);
    need("CiA 406", kind == multi_sensor ? Needed{0x6020, "position value for multi-sensor devices"}
                                         : Needed{0x6004, "position value"});
    if (kind == multi_turn) need("CiA 406", {0x6502, "number of distinguishable revolutions"});
  }

  const ObjectDictionary& dictionary_;
  std::uint16_t base_;
  ObjectKey device_type_;
  Report& report_;
  std::vector<std::uint16_t> reported_;
};

}  // namespace

void check_profile(const ObjectDictionary& dictionary, Report& report) {
  constexpr std::uint16_t step = 0x800;  // CiA 301, 7.4.1: up to eight modules
  const auto value = unsigned_of(dictionary, {0x1000, 0});
  if (!value) return;
  if (static_cast<std::uint32_t>(*value) >> 16 != 0xFFFF) {
    return ProfileCheck{dictionary, 0, {0x1000, 0}, report}.run();
  }
  for (std::uint16_t base = 0; base < 8 * step; base += step) {
    const ObjectKey type{static_cast<std::uint16_t>(0x67FF + base), 0};
    if (unsigned_of(dictionary, type)) ProfileCheck{dictionary, base, type, report}.run();
  }
}

}  // namespace takt
