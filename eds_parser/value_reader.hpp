#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "eds_parser/number.hpp"
#include "eds_parser/object_dictionary.hpp"
#include "eds_parser/report.hpp"

namespace takt {

/// Where a text stands, for findings: "2001:02 DefaultValue".
struct ValuePlace {
  ObjectKey key;
  std::string_view what;  ///< "DefaultValue", a literal
  SourcePos pos;
  Severity misfit = Severity::error;  ///< of a number that the type cannot hold
  Severity unreadable = Severity::warning;
};

/// Turns texts of a file into values of a data type, and says what was odd about them. A text that
/// cannot be read gives no value and a finding: never a clipped or guessed one.
class ValueReader {
 public:
  ValueReader(Report& report, std::optional<NodeId> node) noexcept : report_{report}, node_{node} {}

  /// Value of `type`; none where the text is empty, unreadable or needs an unknown node id.
  std::optional<Value> read(std::string_view text, DataType type, const ValuePlace& place);
  /// A number of the file's own structure (SubNumber, list entries ...), at most `highest`.
  std::optional<std::uint32_t> read_count(std::string_view text, std::uint32_t highest,
                                          std::string_view key, SourcePos pos);
  bool read_flag(std::string_view text, std::string_view key, SourcePos pos);

 private:
  std::optional<Value> read_integer(std::string_view text, DataType type, const ValuePlace& place);
  std::optional<Value> read_real(std::string_view text, DataType type, const ValuePlace& place);
  std::optional<Value> read_bytes(std::string_view text, const ValuePlace& place);
  std::optional<Value> read_time(std::string_view text, DataType type, const ValuePlace& place);
  std::optional<Value> read_untyped(std::string_view text);
  bool flag_of(const ParsedNumber& number, std::string_view text, std::string_view key,
               SourcePos pos);
  void tell_quirks(std::uint16_t quirks, std::string_view text, const ValuePlace& place);
  /// The text before a comment; that there is one is told.
  std::string_view without_told_comment(std::string_view text, const ValuePlace& place);
  void exceeds(std::string_view text, DataType type, const ValuePlace& place);
  void tell_wrapped(std::string_view text, DataType type, const Value& value,
                    const ValuePlace& place);
  void unreadable(std::string_view text, std::string_view wanted, const ValuePlace& place);

  Report& report_;
  std::optional<NodeId> node_;
};

/// "2001:02 DefaultValue".
std::string to_string(const ValuePlace& place);

}  // namespace takt
