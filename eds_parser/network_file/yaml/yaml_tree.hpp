#pragma once
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/report/source.hpp"

namespace takt {

struct YamlNode;

struct YamlPair {
  std::string key;
  SourcePos key_pos;
  const YamlNode* value = nullptr;
};

/// A YAML value with its position in the file. Aliases point to the anchored node, merge keys are
/// already merged, and keys are unique.
struct YamlNode {
  enum class Kind : std::uint8_t { null, scalar, sequence, map };
  Kind kind = Kind::null;
  bool quoted = false;
  std::string text{};
  SourcePos pos{};
  std::vector<YamlPair> pairs{};
  std::vector<const YamlNode*> items{};

  const YamlNode* find(std::string_view key) const noexcept;
};

/// One YAML document as a tree without cycles. Depth, number of nodes and merged pairs are bounded
/// for every text.
class YamlTree {
 public:
  static constexpr std::size_t max_text = 1 << 20;
  static constexpr std::size_t max_depth = 32;
  static constexpr std::size_t max_nodes = 100'000;
  static constexpr std::size_t max_merged = 100'000;

  /// Parses a text. Appends errors (syntax, bounds, duplicate keys) to `findings`.
  static YamlTree parse(std::string_view text, const std::string& file, Findings& findings);

  /// Returns null if the text could not be read.
  const YamlNode* root() const noexcept { return root_; }

 private:
  friend class YamlTreeBuilder;
  std::deque<YamlNode> nodes_;  // elements keep their addresses
  const YamlNode* root_ = nullptr;
};

std::string_view name(YamlNode::Kind kind) noexcept;

/// Reads the text of a file, up to one byte more than a YamlTree accepts. Returns std::nullopt if
/// there is no such file or it can't be read.
std::optional<std::string> read_limited_file(const std::filesystem::path& path);

}  // namespace takt
