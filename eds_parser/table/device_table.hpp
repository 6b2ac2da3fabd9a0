#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/table/mechanics.hpp"
#include "eds_parser/values/data_type.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// SDO access of an object. CiA 306, 4.6.3.2.
enum class Access : std::uint8_t { ro, wo, rw, rwr, rww, constant };

/// Returns the access type as an EDS writes it, for example "ro" or "const".
std::string_view access_name(Access access) noexcept;

/// One object or sub-object of a simulated device.
struct DeviceObject {
  ObjectKey key;
  DataType type = DataType::unknown;
  Access access = Access::rw;
  bool pdo_mappable = false;
  std::vector<std::byte> value{};  ///< power-on value, little endian; strings without terminator
  std::optional<std::int64_t> low_limit{};
  std::optional<std::int64_t> high_limit{};
};

/// The object dictionary with which a simulated device starts, from an EDS or DCF. $NODEID is
/// resolved.
struct DeviceTable {
  NodeId node;
  std::string name;
  std::vector<DeviceObject> objects{};  ///< in ascending order of their keys
  std::uint8_t granularity = 8;  ///< granularity of PDO mapping, in bits; 0 = the mapping is fixed
  std::uint8_t dummy_usage = 0;  ///< bit n set: data type n may be mapped as a dummy
  std::string model;             ///< "drive402", "io401", "lenze8400", "plain" ...
  std::vector<std::string> quirks;  ///< "late_bootup", ...
  std::string firmware{};           ///< "15.02.00"; empty = the newest version of the model
  /// The mechanics behind the axes of a `drive402`. If empty, each motor is simulated by simple
  /// lags of velocity and position.
  std::optional<MechanicsTable> mechanics{};
};

}  // namespace takt
