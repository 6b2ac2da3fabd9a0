#pragma once
#include <algorithm>
#include <string>
#include <string_view>

#include "eds_parser/check/check.hpp"
#include "eds_parser/read/eds.hpp"

namespace takt::test {

/// The headers and mandatory objects of a device without faults. Tests append their objects.
inline constexpr std::string_view base = R"([FileInfo]
FileName=t.eds
[DeviceInfo]
VendorName=V
VendorNumber=0x15A
ProductName=P
ProductNumber=2
RevisionNumber=3
BaudRate_500=1
Granularity=8
NrOfRXPDO=0
NrOfTXPDO=0
[DummyUsage]
Dummy0005=1
[MandatoryObjects]
SupportedObjects=3
1=0x1000
2=0x1001
3=0x1018
[1000]
ParameterName=Device type
DataType=0x0007
AccessType=ro
DefaultValue=0
[1001]
ParameterName=Error register
DataType=5
AccessType=ro
[1018]
ParameterName=Identity
ObjectType=9
SubNumber=2
[1018sub0]
ParameterName=n
DataType=5
AccessType=ro
DefaultValue=1
[1018sub1]
ParameterName=vendor
DataType=7
AccessType=ro
DefaultValue=0x15A
)";

/// Reads `base` and the objects of the test as node 5. The test has to list its objects in
/// [OptionalObjects] and [ManufacturerObjects]; otherwise there is the finding "object-not-listed".
inline EdsFile read(std::string_view objects, std::optional<NodeId> node = 5_node) {
  return read_eds(std::string{base} + std::string{objects}, "t.eds", node);
}

/// Converts a line (from 1) of the test's own part to the line in the text that read() makes.
inline std::uint32_t line_of(std::uint32_t line) {
  return static_cast<std::uint32_t>(std::ranges::count(base, '\n')) + line;
}

inline const Finding* find(const Findings& findings, std::string_view rule) {
  const auto it = std::ranges::find(findings, rule, &Finding::rule);
  return it == findings.end() ? nullptr : &*it;
}

inline bool has(const Findings& findings, std::string_view rule) {
  return find(findings, rule) != nullptr;
}

/// Returns the default value of an object as an integer; empty if there is none.
inline std::optional<std::int64_t> integer(const EdsFile& file, ObjectKey key) {
  const auto* sub = file.dictionary.find(key);
  if (sub == nullptr || !sub->value()) return std::nullopt;
  return as_integer(*sub->value());
}

/// Makes the object 2000, a VAR with the given type and default value.
inline std::string var(std::string_view type, std::string_view value) {
  return "[2000]\nParameterName=x\nAccessType=rw\nDataType=" + std::string{type} +
         "\nDefaultValue=" + std::string{value} + "\n";
}

}  // namespace takt::test
