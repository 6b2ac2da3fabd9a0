#include "eds_parser/network_file/yaml/yaml_tree.hpp"

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <utility>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include "eds_parser/values/name_of.hpp"

namespace takt {
namespace {

SourcePos position(const YAML::Mark& mark) {
  if (mark.is_null()) return {};
  return {static_cast<std::uint32_t>(mark.line + 1), static_cast<std::uint32_t>(mark.column + 1)};
}

/// An exception that is thrown to leave yaml-cpp's parser. The cause is already in the findings.
struct Stop {};

}  // namespace

/// Builds the tree from the parser's events.
class YamlTreeBuilder : public YAML::EventHandler {
 public:
  YamlTreeBuilder(YamlTree& tree, const std::string& file, Findings& findings)
      : tree_{tree}, file_{file}, findings_{findings} {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    finish(add(mark, anchor, YamlNode::Kind::null));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end() || found->second.second) {
      stop(position(mark), "alias", "this alias refers to a value that contains the alias itself");
    }
    attach(found->second.first, position(mark));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    YamlNode& node = add(mark, anchor, YamlNode::Kind::scalar);
    node.quoted = tag == "!";
    node.text = value;
    finish(node);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(add(mark, anchor, YamlNode::Kind::sequence), anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(add(mark, anchor, YamlNode::Kind::map), anchor);
  }
  void OnMapEnd() override {
    merge(*stack_.back().node, stack_.back().merges);
    close();
  }

 private:
  struct Open {
    YamlNode* node;
    YAML::anchor_t anchor;
    const YamlNode* key = nullptr;  ///< for a map: the key that waits for its value
    SourcePos key_pos;
    std::vector<std::pair<const YamlNode*, SourcePos>> merges;
    std::map<std::string, SourcePos, std::less<>> seen;
  };

  [[noreturn]] void stop(SourcePos pos, std::string_view rule, std::string message) {
    findings_.push_back({file_, pos, Severity::error, rule, std::move(message)});
    throw Stop{};
  }

  YamlNode& add(const YAML::Mark& mark, YAML::anchor_t anchor, YamlNode::Kind kind) {
    if (tree_.nodes_.size() >= YamlTree::max_nodes) {
      stop(position(mark), "too-large", "more than 100000 values in one file");
    }
    YamlNode& node = tree_.nodes_.emplace_back();
    node.kind = kind;
    node.pos = position(mark);
    if (anchor != 0) anchors_[anchor] = {&node, true};
    anchor_of_ = anchor;
    return node;
  }

  void open(YamlNode& node, YAML::anchor_t anchor) {
    if (stack_.size() >= YamlTree::max_depth) {
      stop(node.pos, "too-deep", "nested more than 32 levels deep");
    }
    stack_.push_back({.node = &node, .anchor = anchor, .key_pos = {}, .merges = {}, .seen = {}});
  }

  void close() {
    const Open done = std::move(stack_.back());
    stack_.pop_back();
    anchor_of_ = done.anchor;
    finish(*done.node);
  }

  void finish(YamlNode& node) {
    if (anchor_of_ != 0) anchors_[anchor_of_].second = false;
    attach(&node, node.pos);
  }

  void attach(const YamlNode* node, SourcePos pos) {
    if (stack_.empty()) {
      tree_.root_ = node;
      return;
    }
    Open& parent = stack_.back();
    if (parent.node->kind == YamlNode::Kind::sequence) {
      parent.node->items.push_back(node);
    } else if (parent.key == nullptr) {
      if (node->kind != YamlNode::Kind::scalar) stop(pos, "syntax", "a key has to be plain text");
      parent.key = node;
      parent.key_pos = pos;
    } else {
      add_pair(parent, *node, pos);
      parent.key = nullptr;
    }
  }

  void add_pair(Open& parent, const YamlNode& value, SourcePos value_pos) {
    if (parent.key->text == "<<" && !parent.key->quoted) {
      parent.merges.emplace_back(&value, value_pos);
      return;
    }
    const auto [first, is_new] = parent.seen.emplace(parent.key->text, parent.key_pos);
    if (!is_new) {
      findings_.push_back({file_, parent.key_pos, Severity::error, "duplicate-key",
                           "key `" + parent.key->text + "` is written twice, first in line " +
                               std::to_string(first->second.line) + ": keep one"});
      return;
    }
    parent.node->pairs.push_back({parent.key->text, parent.key_pos, &value});
  }

  /// Applies YAML 1.1 merge keys: own keys have priority, then earlier maps of the list.
  void merge(YamlNode& map, const std::vector<std::pair<const YamlNode*, SourcePos>>& merges) {
    if (merges.empty()) return;
    std::set<std::string, std::less<>> keys;
    for (const YamlPair& pair : map.pairs) keys.insert(pair.key);
    for (const auto& [source, pos] : merges) {
      if (source->kind == YamlNode::Kind::sequence) {
        for (const YamlNode* item : source->items) merge_one(map, *item, pos, keys);
      } else {
        merge_one(map, *source, pos, keys);
      }
    }
  }

  void merge_one(YamlNode& map, const YamlNode& source, SourcePos pos,
                 std::set<std::string, std::less<>>& keys) {
    if (source.kind != YamlNode::Kind::map) {
      stop(pos, "merge-key",
           "`<<` merges a map or a list of maps, but this is " + std::string{name(source.kind)});
    }
    merged_ += source.pairs.size() + 1;
    if (merged_ > YamlTree::max_merged) {
      stop(pos, "too-large", "merge keys expand to more than 100000 entries");
    }
    for (const YamlPair& pair : source.pairs) {
      if (keys.insert(pair.key).second) map.pairs.push_back(pair);
    }
  }

  YamlTree& tree_;
  const std::string& file_;
  Findings& findings_;
  std::vector<Open> stack_;
  /// The node of each anchor; the flag is true while the node is still being read.
  std::map<YAML::anchor_t, std::pair<YamlNode*, bool>> anchors_;
  YAML::anchor_t anchor_of_ = 0;
  std::size_t merged_ = 0;
};

const YamlNode* YamlNode::find(std::string_view key) const noexcept {
  const auto found = std::ranges::find(pairs, key, &YamlPair::key);
  return found == pairs.end() ? nullptr : found->value;
}

namespace {

/// Returns true if the white space at the beginning of the line contains a tab.
bool indented_by_tab(std::string_view text, std::uint32_t line) {
  for (; line > 1 && !text.empty(); --line) {
    const std::size_t end = text.find('\n');
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
  }
  const std::string_view blanks = text.substr(0, text.find_first_not_of(" \t"));
  return blanks.find('\t') != blanks.npos;
}

}  // namespace

YamlTree YamlTree::parse(std::string_view text, const std::string& file, Findings& findings) {
  YamlTree tree;
  const auto fail = [&](SourcePos pos, std::string_view rule, std::string message) {
    findings.push_back({file, pos, Severity::error, rule, std::move(message)});
    tree.root_ = nullptr;
  };
  if (text.size() > max_text) {
    fail({}, "too-large", "the file is larger than 1 MiB, so it is not a network file");
    return tree;
  }
  try {
    std::istringstream in{std::string{text}};
    YAML::Parser parser{in};
    YamlTreeBuilder builder{tree, file, findings};
    if (!parser.HandleNextDocument(builder)) {
      fail({1, 1}, "syntax", "the file is empty: a network file has `master:` and `nodes:`");
      return tree;
    }
    const YamlNode* first = tree.root_;
    if (parser.HandleNextDocument(builder)) {
      fail(tree.root_ != nullptr ? tree.root_->pos : SourcePos{}, "syntax",
           "a second document begins here (`---`), but a file describes one network");
      return tree;
    }
    tree.root_ = first;
  } catch (const Stop&) {
    tree.root_ = nullptr;
  } catch (const YAML::Exception& error) {
    const SourcePos pos = position(error.mark);
    fail(pos, "syntax",
         indented_by_tab(text, pos.line)
             ? "invalid YAML: the line begins with a tab; YAML allows only spaces for indentation"
             : "invalid YAML: " + error.msg);
  }
  return tree;
}

std::optional<std::string> read_limited_file(const std::filesystem::path& path) {
  std::error_code error;
  std::ifstream in{path, std::ios::binary};
  if (!std::filesystem::is_regular_file(path, error) || !in) return {};
  std::string text(YamlTree::max_text + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

std::string_view name(YamlNode::Kind kind) noexcept {
  static constexpr std::string_view names[]{"an empty value", "a single value", "a list", "a map"};
  return name_of(kind, names, "a value");
}

}  // namespace takt
