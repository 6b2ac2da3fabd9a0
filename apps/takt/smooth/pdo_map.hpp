#pragma once
#include <cstdint>
#include <expected>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/takt/learn/device_files.hpp"
#include "apps/takt/learn/learned_bus.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt::smooth {

/// One object in the frames of a PDO.
struct MapField {
  ObjectKey object{};
  unsigned offset = 0;  ///< bits
  unsigned bits = 0;    ///< 1..64
};

/// A PDO whose mapping is known.
struct MapPdo {
  CobId id{};
  std::uint8_t node = 0;
  bool is_rpdo = false;
  std::optional<unsigned> transmission{};
  std::vector<MapField> fields{};
};

/// The known settings of a device.
struct MapNode {
  std::string name{};
  bool boot_seen = false;  ///< all writes of its boot are known
  std::map<ObjectKey, std::uint64_t> values{};
  std::vector<ObjectKey> refused{};  ///< objects whose write the device has refused
};

/// The positions of the signals in the frames of a bus.
struct PdoMap {
  std::map<CobId, MapPdo> pdos{};
  std::map<std::uint8_t, MapNode> nodes{};
  CobId sync_id = CobId::base(0x080);
  std::optional<Time> sync_period{};
  std::uint32_t bitrate = 0;  ///< bit/s; 0 = not known
};

/// Takes the PDOs and the boot of a network file.
void add_plan(PdoMap& map, const BusPlan& plan);
/// Adds the values of the SDO transfers in a recording. Values that the transfers do not show come
/// from the device files. Both take precedence over the values that the map has.
void add_learned(PdoMap& map, const learn::LearnedBus& bus, const learn::DeviceFiles& files);
/// Takes a PDO in the form `0x205=6040,607A`, the value of option --pdo. An object that is not of
/// CiA 402 needs its width: `2000:01/16`. The error is a sentence.
std::expected<void, std::string> add_pdo(PdoMap& map, const std::string& text);

}  // namespace takt::smooth
