#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/ini/ini.hpp"
#include "eds_parser/ini/number.hpp"
#include "eds_parser/report/report.hpp"

namespace takt {

/// The place of a text for findings: "2001:02 DefaultValue".
struct ValuePlace {
  ObjectKey key;
  std::string_view what;  ///< the key, such as "DefaultValue"; must be a literal
  SourcePos pos;
  Severity misfit = Severity::error;  ///< severity if the type cannot hold the number
  Severity unreadable = Severity::warning;
};

/// Converts texts of a file to values of a data type, and reports what is unusual about them. A
/// text that cannot be read gives a finding and no value; values are never clipped or guessed.
class ValueReader {
 public:
  ValueReader(Report& report, std::optional<NodeId> node) noexcept : report_{report}, node_{node} {}

  /// Returns the value as `type`. Returns std::nullopt if the text is empty, unreadable, or needs
  /// an unknown node-ID.
  std::optional<Value> read(std::string_view text, DataType type, const ValuePlace& place);
  /// Reads a number of the structure of the file (SubNumber, list entries ...), at most `highest`.
  std::optional<std::uint32_t> read_count(const IniEntry& entry, std::uint32_t highest);
  bool read_flag(const IniEntry& entry);

 private:
  std::optional<Value> read_integer(std::string_view text, DataType type, const ValuePlace& place);
  std::optional<Value> read_real(std::string_view text, DataType type, const ValuePlace& place);
  std::optional<Value> read_bytes(std::string_view text, const ValuePlace& place);
  std::optional<Value> read_time(std::string_view text, DataType type, const ValuePlace& place);
  std::optional<Value> read_untyped(std::string_view text);
  /// Returns the text before a comment, and reports that there is a comment.
  std::string_view without_reported_comment(std::string_view text, const ValuePlace& place);
  void exceeds(std::string_view text, DataType type, const ValuePlace& place);
  void report_wrapped(std::string_view text, DataType type, const Value& value,
                      const ValuePlace& place);
  void unreadable(std::string_view text, std::string_view wanted, const ValuePlace& place);

  Report& report_;
  std::optional<NodeId> node_;
};

/// Returns the place as text: "2001:02 DefaultValue".
std::string to_string(const ValuePlace& place);

}  // namespace takt
