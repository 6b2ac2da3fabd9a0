#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "eds_parser/dictionary/boxed_text.hpp"
#include "eds_parser/report/source.hpp"
#include "eds_parser/table/device_table.hpp"
#include "eds_parser/values/data_type.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// A value of the dictionary: signed types as int64, unsigned types and BOOLEAN as uint64, real
/// types as double, strings and byte types as their bytes.
using Value = std::variant<std::int64_t, std::uint64_t, double, BoxedText>;

/// Object codes. CiA 306, 4.6.3.2.
enum class ObjectType : std::uint8_t {
  null = 0x00,
  domain = 0x02,
  deftype = 0x05,
  defstruct = 0x06,
  var = 0x07,
  array = 0x08,
  record = 0x09,
};

/// The list of the file that names the object. `unlisted` objects are read as well.
enum class ObjectList : std::uint8_t { mandatory, optional, manufacturer, unlisted };

/// An object that holds a value: a VAR, or one entry of an ARRAY or RECORD. Large files have tens
/// of thousands of them, so the small members are placed together to save memory.
struct SubObject {
  std::uint8_t sub = 0;
  Access access = Access::rw;
  bool pdo_mappable = false;
  DataType type = DataType::unknown;
  std::uint16_t type_code = 0;  ///< data type code of the file, even if takt does not know it
  std::uint32_t flags = 0;  ///< ObjFlags: bit 0 refuse write on download, bit 1 refuse read on scan
  SourcePos pos;            ///< place of its section
  SourcePos default_pos;    ///< place of DefaultValue, or of the section
  SourcePos parameter_pos;  ///< place of ParameterValue; 0:0 if there is none
  std::string name;         ///< UTF-8
  std::optional<Value> low_limit;
  std::optional<Value> high_limit;
  std::optional<Value> default_value;    ///< $NODEID is resolved; empty if the node-ID is unknown
  std::optional<Value> parameter_value;  ///< ParameterValue of a DCF
  std::string default_text;              ///< the value as written
  std::string parameter_text;
  std::string denotation;

  /// Returns the ParameterValue of the DCF, else the default.
  const std::optional<Value>& value() const noexcept {
    return parameter_value ? parameter_value : default_value;
  }
  /// Returns the text of value() as written.
  const std::string& text() const noexcept {
    return parameter_text.empty() ? default_text : parameter_text;
  }
  /// Returns the place of value().
  SourcePos value_pos() const noexcept { return parameter_value ? parameter_pos : default_pos; }
  bool is_writable() const noexcept { return access != Access::ro && access != Access::constant; }
  /// Returns true if a master writes the object: it is writable, and ObjFlags do not forbid the
  /// write.
  bool is_configurable() const noexcept { return is_writable() && (flags & 1) == 0; }
};

struct Object {
  std::uint16_t index = 0;
  std::string name;
  /// Denotation of an ARRAY or RECORD as a whole; a VAR has its denotation in sub 0.
  std::string denotation;
  ObjectType type = ObjectType::var;
  ObjectList list = ObjectList::unlisted;
  std::vector<SubObject> subs;  ///< in ascending order; a VAR has exactly sub 0
  SourcePos pos;
};

/// [DeviceInfo]. CiA 306, 4.5.
struct DeviceInfo {
  std::string vendor_name;
  std::uint32_t vendor_number = 0;
  std::string product_name;
  std::uint32_t product_number = 0;
  std::uint32_t revision_number = 0;
  std::string order_code;
  std::vector<std::uint16_t> baud_rates_kbit;  ///< in ascending order
  bool simple_boot_up_master = false;
  bool simple_boot_up_slave = false;
  /// Granularity of the PDO mapping in bits. 0 means that the mapping is fixed, although the
  /// mapping records may contradict this.
  std::uint8_t granularity = 8;
  std::uint8_t dynamic_channels = 0;
  bool group_messaging = false;
  std::uint16_t nr_rx_pdo = 0;
  std::uint16_t nr_tx_pdo = 0;
  bool lss_supported = false;
  std::uint8_t compact_pdo = 0;
  SourcePos pos;            ///< place of the section; 0:0 if the file has none
  SourcePos nr_rx_pdo_pos;  ///< place of NrOfRXPDO, or of the section
  SourcePos nr_tx_pdo_pos;
  SourcePos granularity_pos;
};

/// [DeviceComissioning] of a DCF. CiA 306, 5.3.
struct Commissioning {
  std::optional<NodeId> node_id;
  std::string node_name;
  std::string node_refd;  ///< NodeRefd: name of the node elsewhere, for example in a drawing
  std::uint16_t baudrate_kbit = 0;
  SourcePos baudrate_pos;  ///< 0:0 if the file has no baud rate
  std::uint32_t net_number = 0;
  std::string network_name;
  std::string net_refd;
  bool manager = false;  ///< CANopenManager: this node is the master
  /// LSS_SerialNumber; 0 means unknown. It is only displayed, because one DCF may serve several
  /// devices. The boot compares the serial number of the network file.
  std::uint32_t serial_number = 0;
  SourcePos pos;  ///< place of the section; 0:0 if the file has none
};

/// The content of [FileInfo] as written. CiA 306, 4.4.
struct FileInfo {
  std::string file_name;
  std::string file_version;
  std::string file_revision;
  std::string eds_version;
  std::string description;
  std::string creation_date;
  std::string creation_time;
  std::string created_by;
  std::string modification_date;
  std::string modification_time;
  std::string modified_by;
  std::string last_eds;  ///< for a DCF: the EDS from which the DCF was made
};

/// [ToolN]: a program of the vendor for this device.
struct VendorTool {
  std::string name;
  std::string command;  ///< may hold $DCF, $EDS, $NODEID
};

/// Information of the file for people and for other programs. None of it is sent to the device.
struct FileNotes {
  FileInfo info;
  std::vector<std::string> comments;  ///< lines of [Comments]
  std::vector<VendorTool> tools;
};

/// The files of a DOMAIN in a DCF. CiA 306, 5.3.
struct DomainFiles {
  ObjectKey key;
  std::string upload;                ///< file that receives the data read from the device
  std::string download;              ///< file with the data for the device
  SourcePos pos{};                   ///< place of DownloadFile, or of UploadFile if there is none
  std::vector<std::byte> content{};  ///< content of `download`; filled when a network is loaded
};

/// ParamRefd of a DCF: the name of an object elsewhere. CiA 306-1.
struct ParameterReference {
  std::uint16_t index = 0;
  std::optional<std::uint8_t> sub;  ///< empty for the ARRAY or RECORD as a whole
  std::string text;
};

/// A module type that a modular device supports. CiA 306, 6.
struct ModuleInfo {
  std::uint16_t number = 0;  ///< x of [MxModuleInfo]
  std::string product_name;
  std::string product_version;   ///< the text as written
  std::string product_revision;  ///< the text as written
  std::string order_code;
};

/// [xxxxObjectLinks]: objects that belong together. CiA 306, 4.6.4.
struct ObjectLinks {
  std::uint16_t index = 0;
  std::vector<std::uint16_t> to;
};

/// A segment of [DynamicChannels]: objects that the program of the device may create.
struct DynamicChannel {
  std::uint16_t type_code = 0;
  DataType type = DataType::unknown;
  Access direction = Access::ro;  ///< access from the view of other devices
  std::uint16_t first = 0;        ///< first index
  std::uint16_t last = 0;
  std::uint32_t offset = 0;  ///< PPOffset: offset in the process picture of the program
  std::uint32_t most = 0;    ///< MaxCnt: highest number of objects; 0 means the size of the range
  SourcePos pos;             ///< place of Range
};

/// The content of an EDS or DCF.
struct ObjectDictionary {
  std::string file;
  bool is_dcf = false;
  std::optional<NodeId> node_id;  ///< node-ID given by the caller, else that of the file
  DeviceInfo device;
  Commissioning commissioning;
  std::array<bool, 8> dummy_usage{};  ///< [n]: data type n may be mapped as a dummy
  std::vector<Object> objects;        ///< in ascending order of index
  FileNotes notes;
  std::vector<DomainFiles> domain_files;                 ///< in the order of the file
  std::vector<ObjectLinks> links;                        ///< in the order of the file
  std::vector<DynamicChannel> channels;                  ///< in the order of the file
  std::vector<ParameterReference> parameter_references;  ///< in ascending order of index
  std::vector<ModuleInfo> modules;                       ///< in ascending order of number
  std::vector<std::uint16_t>
      connected_modules;  ///< the module number in each slot, first slot first

  const Object* find(std::uint16_t index) const noexcept;
  const SubObject* find(ObjectKey key) const noexcept;
};

/// Returns the value as an integer, or std::nullopt for reals and strings. An unsigned value above
/// 2^63 - 1 gives the negative number with the same bits.
std::optional<std::int64_t> as_integer(const Value& value) noexcept;
/// Returns true if `value` is below the low limit or above the high limit. Texts have no order and
/// are never outside.
bool outside_limits(const Value& value, const SubObject& sub) noexcept;
/// Returns the bytes of a value on the wire: little endian, with the width of `type`. Strings keep
/// their bytes, except for UNICODE_STRING, which becomes UTF-16.
std::vector<std::byte> to_bytes(const Value& value, DataType type);
/// Formats a value of `type` as CiA 306 writes it, so that it reads back as the same value.
std::string eds_value_text(const Value& value, DataType type);

}  // namespace takt
