#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <yaml-cpp/yaml.h>

#include "eds_parser/report/source.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// One key of an entry of a YAML list, with its value.
struct EntryItem {
  explicit EntryItem(const std::pair<YAML::Node, YAML::Node>& pair)
      : key{pair.first.as<std::string>("")},
        key_mark{pair.first.Mark()},
        is_scalar{pair.second.IsScalar()},
        text{is_scalar ? pair.second.as<std::string>("") : std::string{}},
        mark{pair.second.Mark()},
        value{pair.second} {}

  std::string key;
  YAML::Mark key_mark;
  bool is_scalar;
  std::string text;  ///< text of a scalar
  YAML::Mark mark;
  YAML::Node value;
};

/// Returns the place of a mark, or that of the file as a whole.
SourcePos place_of(const YAML::Mark& mark) noexcept;

/// Collects the errors in the entries of a file.
class EntryReader {
 public:
  EntryReader(std::string file, Findings& findings) : file_{std::move(file)}, findings_{findings} {}

  void error(const YAML::Mark& mark, std::string_view rule, std::string message);
  void refuse(const EntryItem& item, const std::string& wanted);
  /// Reads a time with a unit.
  void read_time(Time& time, const EntryItem& item);

 private:
  std::string file_;
  Findings& findings_;
};

}  // namespace takt
