#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/network_file/yaml_tree.hpp"
#include "eds_parser/network_report.hpp"
#include "eds_parser/network_spec.hpp"
#include "eds_parser/source.hpp"

namespace takt {

/// Limits of an integer of the file, and how to speak of it.
struct IntegerRange {
  std::int64_t low = 0;
  std::int64_t high = std::numeric_limits<std::int64_t>::max();
  std::string_view unit = {};  ///< " ms": follows the limits in messages
};

/// The integer that a scalar says. Octal-looking (`010`), out of range or other text: reported.
std::optional<std::int64_t> read_integer(const YamlNode& node, std::string_view key,
                                         IntegerRange range, NetworkReport& report);
std::optional<double> read_number(const YamlNode& node, std::string_view key,
                                  NetworkReport& report);
/// true/false, yes/no, on/off, also quoted (a false with a warning); 0 and 1.
std::optional<bool> read_bool(const YamlNode& node, std::string_view key, NetworkReport& report);
std::optional<std::string> read_text(const YamlNode& node, std::string_view key,
                                     NetworkReport& report);

/// Takes the known keys of one map, then reports what is left over.
class MapReader {
 public:
  /// Where `node` is no map, that is reported and the reader is empty.
  MapReader(const YamlNode& node, std::string what, NetworkReport& report);

  const YamlNode* take(std::string_view key);
  SourcePos key_pos(std::string_view key) const noexcept;
  bool is_map() const noexcept { return node_.kind == YamlNode::Kind::map; }
  /// `key` is not there, but an unknown key that is most likely a slip of it, which finish() tells.
  /// After all keys are taken.
  bool has_slip_of(std::string_view key) const;

  template <class T>
  void integer(std::string_view key, Sourced<T>& out, IntegerRange range) {
    if (const YamlNode* node = take(key)) {
      if (const auto value = read_integer(*node, key, range, report_)) {
        out = {static_cast<T>(*value), node->pos, true};
      }
    }
  }
  template <class T>
  void integer(std::string_view key, Sourced<T>& out) {
    integer(key, out, {0, static_cast<std::int64_t>(std::numeric_limits<T>::max())});
  }
  void number(std::string_view key, Sourced<double>& out);
  void boolean(std::string_view key, Sourced<bool>& out);
  void text(std::string_view key, Sourced<std::string>& out);
  /// As text(); an empty name is none, as to the generators of other masters.
  void file(std::string_view key, Sourced<std::string>& out);

  /// Keys of other readers: a note each where present. `why` ends the sentence.
  void ignore(std::span<const std::string_view> keys, std::string_view why);
  /// Every key that nobody took is an error with a suggestion.
  void finish();
  /// As finish(), for a map that another program reads as well: an error only where the key is
  /// near one that takt reads, else a warning. `why` ends the sentence.
  void finish_shared(std::string_view why);

  NetworkReport& report() noexcept { return report_; }
  const std::string& what() const noexcept { return what_; }

 private:
  const YamlNode& node_;
  std::string what_;
  NetworkReport& report_;
  std::vector<std::string_view> known_;
};

/// Index of `text` in `names`; anything else is an error that lists them.
std::optional<std::size_t> read_choice(const YamlNode& node, std::string_view key,
                                       std::span<const std::string_view> names,
                                       NetworkReport& report);

}  // namespace takt
