#include "eds_parser/network_file/read_network.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <set>
#include <utility>

#include "eds_parser/network_file/sections.hpp"
#include "eds_parser/network_file/yaml_tree.hpp"
#include "eds_parser/report/suggest.hpp"

namespace takt {
namespace {

constexpr std::array<std::string_view, 8> section_names{
    "options", "master", "defaults", "nodes", "bus", "lcm", "realtime", "black_box"};
constexpr std::size_t max_nodes = 127;

bool is_section(std::string_view key) {
  return std::ranges::find(section_names, key) != section_names.end();
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
                    "a network file has to be a map with `master:` and `nodes:`, but this is " +
                        std::string{name(root_.kind)});
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
    const auto section = [&](std::string_view key, auto read) {
      if (const YamlNode* node = root_.find(key)) read(*node, spec_, report_);
    };
    section("options", read_options);
    section("bus", read_bus);
    section("master", read_master);
    section("realtime", read_realtime);
    section("lcm", read_lcm);
    section("black_box", read_black_box);
  }

  void read_top_level(const YamlPair& pair) {
    if (is_node(pair)) return add(pair);
    slipped_ = slipped_ || nearest(pair.key, section_names) == "nodes";
    report_.error(pair.key_pos, "unknown-key",
                  "unknown section `" + pair.key + "` (a node needs a `node_id`)" +
                      did_you_mean(pair.key, section_names));
  }

  /// Whether a section is a node. The master also has a `node_id`, so a section whose name is
  /// almost `master` and that has no device file is not a node.
  bool is_node(const YamlPair& pair) const {
    if (pair.value->kind != YamlNode::Kind::map) return false;
    if (pair.value->find("dcf") != nullptr) return true;
    if (pair.value->find("node_id") == nullptr) return false;
    return nearest(pair.key, section_names) != "master" ||
           with_defaults(*pair.value, root_.find("defaults")).find("dcf") != nullptr;
  }

  void read_nodes(const YamlNode& nodes) {
    if (nodes.kind != YamlNode::Kind::map) {
      report_.error(nodes.pos, "wrong-type",
                    "`nodes` has to be a map of `NAME: {node_id: ..., dcf: ...}`, but this is " +
                        std::string{name(nodes.kind)});
      found_node_ = true;  // this is already reported
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
      return told_.contains({finding.pos, finding.rule});
    };
    findings_.erase(std::remove_if(begin, findings_.end(), repeated), findings_.end());
    for (auto it = findings_.begin() + static_cast<std::ptrdiff_t>(first); it != findings_.end();
         ++it) {
      told_.emplace(it->pos, it->rule);
    }
  }

  const YamlNode& root_;
  NetworkSpec& spec_;
  Findings& findings_;
  NetworkReport report_;
  std::set<std::pair<SourcePos, std::string_view>> told_;
  bool found_node_ = false;
  bool slipped_ = false;  ///< `nodes` is misspelled, and that is already reported
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
