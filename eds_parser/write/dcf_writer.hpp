#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/report/source.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// A value for a DCF, as a user writes it: `0x3E8`, `$NODEID+0x200`, `-5`, a text, hex byte pairs.
/// For a DOMAIN object, `@FILE` gives the device the content of that file (DownloadFile).
struct DcfValue {
  ObjectKey object;
  std::string text;
};

struct DcfOptions {
  std::optional<NodeId> node{};
  std::optional<std::uint16_t> baudrate_kbit{};
  std::string node_name{};
  std::string out_name{};  ///< new [FileInfo] FileName; empty = unchanged
  std::vector<DcfValue> values{};
};

struct DcfText {
  std::string text;
  Findings findings;  ///< if one of them is an error, there is no text
};

/// Turns an EDS or DCF into the DCF of one device. It writes ParameterValue of the given objects,
/// [DeviceComissioning], and LastEDS in [FileInfo]. All other text stays byte for byte, except that
/// a UTF-16 file becomes UTF-8. An object that only CompactPDO or modules imply is written out if
/// it gets a value. A value that the device would refuse (read-only, outside its limits or its
/// type) is an error. CiA 306, 5.
DcfText write_dcf(std::string_view source, const std::string& source_name,
                  const DcfOptions& options);

}  // namespace takt
