#include "eds_parser/network_file/keys/read_network.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "eds_parser/network_file/keys/sections.hpp"
#include "eds_parser/network_file/yaml/yaml_tree.hpp"
#include "eds_parser/report/suggest.hpp"

namespace takt {
namespace {

constexpr std::size_t max_nodes = 127;

std::vector<std::string_view> section_names() {
  std::vector<std::string_view> names;
  for (const auto& section : network_keys()) names.push_back(section.name);
  return names;
}

/// Returns the node, completed by the keys of `defaults` that it does not have itself.
YamlNode with_defaults(const YamlNode& node, const YamlNode* defaults) {
  YamlNode merged = node;
  if (defaults == nullptr || defaults->kind != YamlNode::Kind::map) return merged;
  if (merged.kind == YamlNode::Kind::null) merged.kind = YamlNode::Kind::map;
  for (const YamlPair& pair : defaults->pairs) {
    if (node.find(pair.key) == nullptr) merged.pairs.push_back(pair);
  }
  return merged;
}

class NetworkReader {
 public:
  NetworkReader(const YamlNode& root, NetworkSpec& spec, Findings& findings)
      : root_{root}, spec_{spec}, findings_{findings}, report_{spec.file, findings} {}

  void run() {
    if (root_.kind != YamlNode::Kind::map) {
      report_.error(root_.pos, "wrong-type",
                    "a network file has to be a map with `master:` and `nodes:`, but this is ",
                    name(root_.kind));
      return;
    }
    read_sections();
    for (const YamlPair& pair : root_.pairs) {
      if (!is_section(pair.key) && !pair.key.starts_with('.')) read_top_level(pair);
    }
    if (const YamlNode* nodes = root_.find("nodes")) read_nodes(*nodes);
    if (!found_node_ && !slipped_) {
      report_.error(
          root_.pos, "no-nodes",
          "the file describes no node: expected `nodes:` with `NAME: {node_id: 1..127, dcf: "
          "FILE.eds}`");
    }
  }

 private:
  void read_sections() {
    MapReader map{root_, "the network file", report_};
    for (const auto& section : network_keys()) {
      const YamlNode* node = root_.find(section.name);
      if (node != nullptr && section.read != nullptr) section.read({map, section, *node}, spec_);
    }
  }

  bool is_section(std::string_view key) const {
    return std::ranges::find(names_, key) != names_.end();
  }

  void read_top_level(const YamlPair& pair) {
    if (is_node(pair)) return add(pair);
    slipped_ = slipped_ || nearest(pair.key, names_) == "nodes";
    report_.error(pair.key_pos, "unknown-key", "unknown section `", pair.key,
                  "` (a node needs a `node_id`)", did_you_mean(pair.key, names_));
  }

  /// Returns true if a section is a node. The master also has a `node_id`, so a section whose name
  /// is almost `master` and that has no device file is not a node.
  bool is_node(const YamlPair& pair) const {
    if (pair.value->kind != YamlNode::Kind::map) return false;
    if (pair.value->find("dcf") != nullptr) return true;
    if (pair.value->find("node_id") == nullptr) return false;
    return nearest(pair.key, names_) != "master" ||
           with_defaults(*pair.value, root_.find("defaults")).find("dcf") != nullptr;
  }

  void read_nodes(const YamlNode& nodes) {
    if (nodes.kind != YamlNode::Kind::map) {
      report_.error(nodes.pos, "wrong-type",
                    "`nodes` has to be a map of `NAME: {node_id: ..., dcf: ...}`, but this is ",
                    name(nodes.kind));
      found_node_ = true;  // Avoids a second finding that the file has no node.
      return;
    }
    for (const YamlPair& pair : nodes.pairs) {
      if (!pair.key.starts_with('.')) add(pair);
    }
  }

  void add(const YamlPair& pair) {
    found_node_ = true;
    if (spec_.nodes.size() >= max_nodes) {
      report_.error(pair.key_pos, "too-many", "more than 127 nodes on one bus");
      return;
    }
    const YamlNode merged = with_defaults(*pair.value, root_.find("defaults"));
    const std::size_t first = findings_.size();
    spec_.nodes.push_back(read_node(merged, pair.key, pair.key_pos, report_));
    drop_repeated(first);
  }

  /// Drops repeated findings. The keys of `defaults` are read once for each node but reported only
  /// once.
  void drop_repeated(std::size_t first) {
    const auto begin = findings_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto repeated = [&](const Finding& finding) {
      return reported_.contains({finding.pos, finding.rule});
    };
    findings_.erase(std::remove_if(begin, findings_.end(), repeated), findings_.end());
    for (auto it = findings_.begin() + static_cast<std::ptrdiff_t>(first); it != findings_.end();
         ++it) {
      reported_.emplace(it->pos, it->rule);
    }
  }

  const YamlNode& root_;
  NetworkSpec& spec_;
  Findings& findings_;
  NetworkReport report_;
  const std::vector<std::string_view> names_ = section_names();
  std::set<std::pair<SourcePos, std::string_view>> reported_;
  bool found_node_ = false;
  bool slipped_ = false;  ///< `nodes` is misspelled, and the error was already reported
};

}  // namespace

NetworkSpec read_network(std::string_view text, const std::string& file, Findings& findings) {
  NetworkSpec spec;
  spec.file = file;
  const YamlTree tree = YamlTree::parse(text, file, findings);
  if (tree.root() == nullptr) return spec;
  NetworkReader{*tree.root(), spec, findings}.run();
  return spec;
}

}  // namespace takt
