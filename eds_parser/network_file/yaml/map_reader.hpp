#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/network_file/yaml/yaml_tree.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/report/source.hpp"
#include "eds_parser/specification/network_spec.hpp"

namespace takt {

/// Limits of an integer of the file, and its unit in messages.
struct IntegerRange {
  std::int64_t low = 0;
  std::int64_t high = std::numeric_limits<std::int64_t>::max();
  std::string_view unit = {};  ///< unit, for example "ms"; follows the limits in messages

  constexpr bool operator==(const IntegerRange&) const noexcept = default;
};

/// Returns for example `1..600000 ms`.
std::string to_string(IntegerRange range);

/// Reads the integer in a scalar. Reports a value that looks octal (`010`), is out of range or is
/// no integer.
std::optional<std::int64_t> read_integer(const YamlNode& node, std::string_view key,
                                         IntegerRange range, NetworkReport& report);
std::optional<double> read_number(const YamlNode& node, std::string_view key,
                                  NetworkReport& report);
/// Reads true/false, yes/no, on/off, also quoted (a quoted false gives a warning), 0 or 1.
std::optional<bool> read_bool(const YamlNode& node, std::string_view key, NetworkReport& report);
std::optional<std::string> read_text(const YamlNode& node, std::string_view key,
                                     NetworkReport& report);
/// Reads a key of a map whose keys are numbers, such as the numbers of PDOs.
std::optional<std::int64_t> read_number_key(const YamlPair& pair, std::string_view key,
                                            IntegerRange range, NetworkReport& report);

/// Reads the known keys of one map, then reports the unknown ones.
class MapReader {
 public:
  /// If `node` is not a map, the constructor reports that and the reader is empty.
  MapReader(const YamlNode& node, std::string what, NetworkReport& report);

  const YamlNode* take(std::string_view key);
  SourcePos key_pos(std::string_view key) const noexcept;
  /// Returns false if the value has a wrong type, which the constructor has already reported.
  /// Missing keys of such a value are not reported.
  bool is_readable() const noexcept {
    return node_.kind == YamlNode::Kind::map || node_.kind == YamlNode::Kind::null;
  }
  bool has(std::string_view key) const noexcept { return node_.find(key) != nullptr; }
  /// Returns true if an unknown key, which finish() reports, is most likely a misspelling of `key`.
  /// Call this after all keys are taken.
  bool has_slip_of(std::string_view key) const;

  /// Reports a note for each key that is present and belongs to another program. `keys` holds the
  /// names, separated by blanks; `why` is the end of the message.
  void ignore(std::string_view keys, std::string_view why);
  /// Reports every key that was not taken as an error with a suggestion.
  void finish();
  /// Ends the map as finish() does, for a map that another program also reads. A key is an error
  /// only if it is similar to one that takt reads, otherwise a warning. `why` is the end of the
  /// message.
  void finish_shared(std::string_view why);

  NetworkReport& report() noexcept { return report_; }
  const std::string& what() const noexcept { return what_; }
  const YamlNode& node() const noexcept { return node_; }

 private:
  const YamlNode& node_;
  std::string what_;
  NetworkReport& report_;
  std::vector<std::string_view> known_;
};

/// Returns the index of the node's text in `names`. Any other text is an error whose message lists
/// them.
std::optional<std::size_t> read_choice(const YamlNode& node, std::string_view key,
                                       std::span<const std::string_view> names,
                                       NetworkReport& report);

}  // namespace takt
