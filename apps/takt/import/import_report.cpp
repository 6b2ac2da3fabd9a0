#include "apps/takt/import/import_report.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "apps/takt/import/unasked.hpp"
#include "eds_parser/ini/number.hpp"
#include "eds_parser/network_file/keys/key_reference.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/network_file/yaml/yaml_tree.hpp"
#include "eds_parser/values/name_of.hpp"

namespace takt {
namespace {

constexpr std::size_t longest_value = 60;

/// Returns a value on one line, cut to 60 characters.
std::string value_text(const YamlNode& node) {
  std::string text;
  using enum YamlNode::Kind;
  if (node.kind == scalar) {
    for (const char c : node.text) text += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  for (const YamlNode* const& item : node.items) {
    text += (&item == node.items.data() ? "" : ", ") + value_text(*item);
    if (text.size() > longest_value) break;
  }
  for (const YamlPair& pair : node.pairs) {
    text += (text.empty() ? "" : ", ") + pair.key + ": " + value_text(*pair.value);
    if (text.size() > longest_value) break;
  }
  if (node.kind == sequence) text = '[' + text + ']';
  if (node.kind == map) text = '{' + text + '}';
  return text.size() > longest_value ? text.substr(0, longest_value - 3) + "..." : text;
}

/// A row of the report with the places in the file at which findings on this row may be.
struct Row {
  ImportedKey key;
  std::string_view word;  ///< word for the table of meanings: the key, or the key of its map
  std::set<SourcePos> places;
  bool leaf = true;
  bool wrong_type = false;
  bool unknown = false;        ///< true if takt reads nothing in this map
  std::size_t left_alone = 0;  ///< number of unguarded nodes that do not use the key
};

/// Collects the rows of a file: one for each key that has a value, and one for each entry of a list
/// of maps.
class RowCollector {
 public:
  std::vector<Row> collect(const YamlNode& root) {
    map(root, "", "");
    return std::move(rows_);
  }

 private:
  void map(const YamlNode& node, const std::string& path, std::string_view word) {
    for (const YamlPair& pair : node.pairs) {
      if (path.empty() && pair.key.starts_with('.')) continue;  // only for anchors
      value(*pair.value, pair, path.empty() ? pair.key : path + '.' + pair.key, word);
    }
  }

  /// Collects the rows of a value. `word` is the key of the map around the value.
  void value(const YamlNode& node, const YamlPair& pair, const std::string& path,
             std::string_view word) {
    if (!seen_.emplace(pair.key_pos, pair.key).second) return;  // repeated by an alias
    if (node.kind == YamlNode::Kind::map) {
      add(path, pair.key, "", pair.key_pos, {node.pos}, false);
      map(node, path, pair.key);
    } else if (places_left_ != 0 && holds_maps(node)) {
      add(path, pair.key, "", pair.key_pos, {node.pos}, false);
      items(node, pair.key, path);
    } else {
      std::set<SourcePos> places;
      places_of(node, places);
      const bool is_number = pair.key.find_first_not_of("0123456789") == std::string::npos;
      add(path, is_number ? word : pair.key, value_text(node), pair.key_pos, std::move(places),
          true);
    }
  }

  static bool holds_maps(const YamlNode& node) {
    return std::ranges::any_of(
        node.items, [](const YamlNode* item) { return item->kind == YamlNode::Kind::map; });
  }

  void items(const YamlNode& list, std::string_view word, const std::string& path) {
    for (std::size_t i = 0; i < list.items.size() && places_left_ != 0; ++i) {
      std::set<SourcePos> places;
      places_of(*list.items[i], places);
      add(path + '[' + std::to_string(i + 1) + ']', word, value_text(*list.items[i]),
          list.items[i]->pos, std::move(places), true);
    }
  }

  void places_of(const YamlNode& node, std::set<SourcePos>& places) {
    if (places_left_ == 0) return;
    --places_left_;
    if (!places.insert(node.pos).second) return;  // repeated by an alias
    for (const YamlPair& pair : node.pairs) {
      places.insert(pair.key_pos);
      places_of(*pair.value, places);
    }
    for (const YamlNode* item : node.items) places_of(*item, places);
  }

  void add(std::string path, std::string_view word, std::string value, SourcePos pos,
           std::set<SourcePos> places, bool leaf) {
    places.insert(pos);
    Row& row = rows_.emplace_back();
    row.key.path = std::move(path);
    row.key.value = std::move(value);
    row.key.pos = pos;
    row.word = word;
    row.places = std::move(places);
    row.leaf = leaf;
  }

  std::vector<Row> rows_;
  // Limits the work, because many aliases may name one long list.
  std::size_t places_left_ = 2 * YamlTree::max_nodes;
  std::set<std::pair<SourcePos, std::string>> seen_;
};

KeyUse use_of(const Finding& finding) {
  if (finding.severity == Severity::error) return KeyUse::wrong;
  if (finding.severity == Severity::warning) return KeyUse::suspicious;
  if (finding.rule == "cob-id") return KeyUse::suspicious;  // the device keeps its own bit 30
  const bool ignored =
      finding.rule == "unused-key" || finding.rule == "placeholder" || finding.rule == "guarding";
  return ignored ? KeyUse::ignored : KeyUse::used;
}

/// Returns the innermost row to which a finding refers, or null if there is none. A map begins at
/// the same place as its first key, so a finding on the type of a value at this place refers to the
/// map.
Row* row_of(std::vector<Row>& rows, const Finding& finding) {
  const auto here = [&](const Row& row) { return row.places.contains(finding.pos); };
  const auto map_here = [&](const Row& row) { return !row.leaf && here(row); };
  auto found = std::ranges::find_if(rows.rbegin(), rows.rend(), here);
  if (finding.rule == "wrong-type") {
    const auto map = std::ranges::find_if(rows.rbegin(), rows.rend(), map_here);
    if (map != rows.rend()) found = map;
  }
  return found == rows.rend() ? nullptr : &*found;
}

/// Returns what the key means, without the period at the end.
std::string_view meaning_of(const Row& row) {
  std::string_view text = key_meaning(row.key.path.substr(0, row.key.path.find('.')), row.word);
  if (text.ends_with('.')) text.remove_suffix(1);
  return text;
}

void apply(Row& row, const Finding& finding) {
  const KeyUse use = use_of(finding);
  if (finding.rule == "guarding") ++row.left_alone;
  if (use < row.key.use) return;
  row.wrong_type = row.wrong_type || finding.rule == "wrong-type";
  row.unknown = row.unknown || finding.rule == "unknown-key";
  const std::string_view reason =
      finding.rule == "unused-key" ? meaning_of(row) : std::string_view{};
  const std::string text = reason.empty() ? finding.message : std::string{reason};
  const bool more = use == row.key.use && !row.key.why.empty() && row.key.why != text;
  row.key.why = more ? row.key.why + "; " + text : text;
  row.key.use = use;
}

bool is_within(const Row& row, const std::string& path) {
  const std::string& own = row.key.path;
  return own.size() > path.size() && own.starts_with(path) &&
         (own[path.size()] == '.' || own[path.size()] == '[');
}

void ignore(Row& row, const std::string& why) {
  if (row.key.use != KeyUse::used) return;
  row.key.use = KeyUse::ignored;
  row.key.why = why;
}

/// Marks keys as ignored if their parent is ignored, unknown or of a wrong type.
void ignore_children(std::vector<Row>& rows) {
  for (const Row& parent : rows) {
    if (parent.leaf) continue;
    const bool wrong = parent.unknown || (parent.key.use == KeyUse::wrong && parent.wrong_type);
    if (parent.key.use != KeyUse::ignored && !wrong) continue;
    const std::string why = wrong ? "is part of `" + parent.key.path + "`" : parent.key.why;
    for (Row& row : rows) {
      if (is_within(row, parent.key.path)) ignore(row, why);
    }
  }
}

std::vector<const YamlPair*> nodes_of(const YamlNode& root) {
  std::vector<const YamlPair*> nodes;
  const auto collect = [&](const YamlNode& map) {
    for (const YamlPair& pair : map.pairs) {
      const bool is_map = pair.value->kind == YamlNode::Kind::map;
      if (is_map && pair.value->find("node_id") != nullptr) nodes.push_back(&pair);
    }
  };
  collect(root);
  std::erase_if(nodes, [](const YamlPair* pair) {
    return pair->key == "master" || pair->key == "defaults" || pair->key.starts_with('.');
  });
  if (const YamlNode* listed = root.find("nodes")) collect(*listed);
  return nodes;
}

std::string why_used(const Row& row) {
  return row.key.why.empty() ? std::string{meaning_of(row)} : row.key.why;
}

/// Judges the keys of `defaults`. Such a key applies to a node as a whole, or not at all if the
/// node has the same key.
void judge_defaults(const YamlNode& root, std::vector<Row>& rows) {
  const YamlNode* defaults = root.find("defaults");
  const std::vector<const YamlPair*> nodes = nodes_of(root);
  if (defaults == nullptr || nodes.empty()) return;
  for (const YamlPair& pair : defaults->pairs) {
    std::string own;
    std::size_t count = 0;
    for (const YamlPair* node : nodes) {
      if (node->value->find(pair.key) == nullptr) continue;
      own += (own.empty() ? "`" : ", `") + node->key + '`';
      ++count;
    }
    const std::string path = "defaults." + pair.key;
    for (Row& row : rows) {
      if (row.key.path != path && !is_within(row, path)) continue;
      if (row.left_alone != 0 && row.left_alone < nodes.size() - count) {
        row.key.use = KeyUse::used;
        row.key.why = std::string{meaning_of(row)} + "; but " + row.key.why;
      }
      if (count == 0) continue;
      if (count == nodes.size()) {
        ignore(row, "each node has its own `" + pair.key + "`, which replaces this one as a whole");
      } else if (row.leaf && row.key.use == KeyUse::used) {
        row.key.why = why_used(row) + "; not for " + own + " with its own `" + pair.key + "`";
      }
    }
  }
}

/// Compares values. Each pair of values is compared only once, even if many aliases name it.
class Comparison {
 public:
  bool same(const YamlNode& a, const YamlNode& b) {
    if (&a == &b) return true;
    if (a.kind != b.kind) return false;
    if (a.kind == YamlNode::Kind::scalar) return same_scalar(a.text, b.text);
    const auto [known, is_new] = known_.try_emplace({&a, &b}, false);
    if (is_new) known->second = same_parts(a, b);
    return known->second;
  }

 private:
  static bool same_scalar(const std::string& a, const std::string& b) {
    const auto x = parse_number(a);
    const auto y = parse_number(b);
    return a == b || (x && y && x->magnitude == y->magnitude && x->negative == y->negative &&
                      x->node_ids == y->node_ids && (x->quirks | y->quirks) == 0);
  }

  bool same_parts(const YamlNode& a, const YamlNode& b) {
    const auto same_pair = [this](const YamlPair& x, const YamlPair& y) {
      return x.key == y.key && same(*x.value, *y.value);
    };
    const auto same_item = [this](const YamlNode* x, const YamlNode* y) { return same(*x, *y); };
    return std::ranges::equal(a.pairs, b.pairs, same_pair) &&
           std::ranges::equal(a.items, b.items, same_item);
  }

  std::map<std::pair<const YamlNode*, const YamlNode*>, bool> known_;
};

/// Marks keys of nodes that differ from the same key of `defaults`. The generator of ros2_canopen
/// copies `defaults` over the keys of each node under `nodes`, so the node's own value was never in
/// effect there.
void judge_overrides(const YamlNode& root, std::vector<Row>& rows) {
  const YamlNode* defaults = root.find("defaults");
  const YamlNode* nodes = root.find("nodes");
  if (defaults == nullptr || nodes == nullptr) return;
  std::unordered_map<std::string, Row*> row_at;
  for (Row& row : rows) row_at.try_emplace(row.key.path, &row);
  Comparison comparison;
  for (const YamlPair& node : nodes->pairs) {
    for (const YamlPair& own : node.value->pairs) {
      const YamlNode* common = defaults->find(own.key);
      if (common == nullptr || comparison.same(*common, *own.value)) continue;
      const auto found = row_at.find("nodes." + node.key + '.' + own.key);
      if (found == row_at.end() || found->second->key.use != KeyUse::used) continue;
      ImportedKey& key = found->second->key;
      key.use = KeyUse::suspicious;
      key.why =
          "takt uses this value; ros2_canopen (cogen) uses that of `defaults`: the machine has run "
          "with " +
          (value_text(*common).empty() ? "that value" : '`' + value_text(*common) + '`');
    }
  }
}

}  // namespace

std::string_view name(KeyUse use) noexcept {
  static constexpr std::string_view names[]{"used", "ignored", "suspicious", "wrong"};
  return name_of(use, names);
}

std::size_t ImportReport::count(KeyUse use) const noexcept {
  return static_cast<std::size_t>(std::ranges::count(keys, use, &ImportedKey::use));
}

ImportReport import_report(const std::filesystem::path& path) {
  const LoadedNetwork network = load_network(path);
  Findings syntax;
  const std::string text = read_limited_file(path).value_or("");
  const YamlTree tree = YamlTree::parse(text, path.string(), syntax);
  std::vector<Row> rows;
  if (tree.root() != nullptr) rows = RowCollector{}.collect(*tree.root());

  ImportReport report;
  report.usable = !has_error(network.findings);
  for (const Finding& finding : network.findings) {
    Row* row = finding.file == path.string() && finding.pos != SourcePos{} ? row_of(rows, finding)
                                                                           : nullptr;
    if (row == nullptr) {
      report.others.push_back(finding);
    } else {
      apply(*row, finding);
    }
  }
  if (tree.root() != nullptr) {
    judge_defaults(*tree.root(), rows);
    judge_overrides(*tree.root(), rows);
    if (report.usable) report.unasked = unasked(*tree.root(), network.plan);
  }
  ignore_children(rows);
  for (Row& row : rows) {
    if (!row.leaf && row.key.why.empty()) continue;
    if (row.key.why.empty()) row.key.why = meaning_of(row);
    report.keys.push_back(std::move(row.key));
  }
  return report;
}

}  // namespace takt
