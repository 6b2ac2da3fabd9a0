#include "apps/takt/import/nodelist.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "eds_parser/ini/ini.hpp"
#include "eds_parser/ini/value_reader.hpp"
#include "eds_parser/network_file/yaml/yaml_tree.hpp"
#include "eds_parser/read/eds.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_name = 40;

std::string lower(std::string_view text) {
  std::string out{text};
  std::ranges::transform(out, out.begin(), fold);
  return out;
}

/// Returns a value that YAML reads as exactly this text. Control characters become blanks.
std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return out + '"';
}

/// Returns a name that can be part of an LCM channel: `Axis 1 (left)` becomes `axis_1_left`.
std::string plain_name(std::string_view text, const std::string& otherwise) {
  std::string out;
  for (const char c : lower(text)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (plain) {
      out += c;
    } else if (!out.empty() && out.back() != '_') {
      out += '_';
    }
  }
  out = out.substr(0, longest_name);
  while (!out.empty() && out.back() == '_') out.pop_back();
  if (out.empty() || out == "all") return otherwise;
  return out.front() >= '0' && out.front() <= '9' ? otherwise + '_' + out : out;
}

/// Splits a key like `node12dcfname` into 12 and `dcfname`. Returns std::nullopt for other keys.
std::optional<std::pair<unsigned, std::string>> node_key(std::string_view key) {
  constexpr std::string_view prefix = "node";
  const std::string word = lower(key);
  if (!word.starts_with(prefix)) return std::nullopt;
  unsigned number = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data() + prefix.size(), end, number);
  if (error != std::errc{} || stop == end) return std::nullopt;
  return std::pair{number, std::string{stop, end}};
}

struct ListedNode {
  std::optional<std::size_t> present{};  ///< row of the key in the report
  std::optional<std::size_t> name{};     ///< row of the key in the report
  std::optional<std::size_t> dcf{};      ///< row of the key in the report
  bool is_present = false;
  std::string file{};   ///< path of the device file in the network file
  std::string label{};  ///< name of the node in the network file
  SourcePos pos{};      ///< place of its first key
};

class Importer {
 public:
  Importer(const fs::path& cpj, unsigned number, const fs::path& folder)
      : cpj_{cpj},
        folder_{folder},
        section_{number <= 1 ? "Topology" : fmt::format("Topology{}", number)},
        is_first_{number <= 1},
        report_{cpj.string()},
        values_{report_, std::nullopt} {}

  ImportedNodelist run() {
    const std::string text = read_limited_file(cpj_).value_or("");
    if (text.empty() || text.size() > YamlTree::max_text) {
      wrong({}, "no-file", "can't be read, is empty, or is larger than 1 MB");
      return finish();
    }
    const IniFile file = read_ini(text, report_);
    const IniSection* topology = find_topology(file);
    if (topology == nullptr) {
      wrong({}, "no-topology",
            "there is no [" + section_ +
                "]: the file is not a nodelist.cpj of CiA 306-3, or has no such network");
      return finish();
    }
    for (const IniEntry& entry : file.entries(*topology)) read(entry);
    compare_count(*topology);
    for (auto& [id, node] : nodes_) use(id, node);
    if (!wrong_) write();
    return finish();
  }

 private:
  const IniSection* find_topology(const IniFile& file) {
    const IniSection* found = nullptr;
    for (const IniSection& section : file.sections) {
      const std::string name = lower(section.name);
      const bool wanted = name == lower(section_) || (is_first_ && name == "topology1");
      if (wanted && found == nullptr) {
        found = &section;
        title_ = std::string{section.name};
        continue;
      }
      const bool other = name.starts_with("topology");
      report_.note(section.pos, "unused-key",
                   "[" + to_utf8(section.name) + "] " +
                       (other ? "is another network; `--network` chooses a network"
                              : "is not a section of a nodelist.cpj; takt left it out"));
    }
    return found;
  }

  void wrong(SourcePos pos, std::string_view rule, const std::string& message) {
    wrong_ = true;
    report_.error(pos, rule, message);
  }

  std::size_t add(const IniEntry& entry, KeyUse use, std::string why) {
    rows_.push_back({.path = title_ + '.' + to_utf8(entry.key),
                     .value = to_utf8(entry.value),
                     .pos = entry.pos(),
                     .use = use,
                     .why = std::move(why)});
    return rows_.size() - 1;
  }

  void read(const IniEntry& entry) {
    const std::string key = lower(entry.key);
    if (key == "netname") {
      name_ = to_utf8(entry.value);
      add(entry, KeyUse::used, "name of the bus, part of the LCM channels");
    } else if (key == "nodes") {
      count_ = values_.read_count(entry, 127);
      count_row_ = add(entry, KeyUse::used, "compared with the nodes that are listed");
    } else if (key == "netrefd") {
      add(entry, KeyUse::ignored, "a reference for readers");
    } else if (key == "edsbasename") {
      base_ = slashes(to_utf8(entry.value));
      add(entry, KeyUse::used, "second folder for device files");
    } else if (const auto of_node = node_key(entry.key)) {
      read_node(entry, of_node->first, of_node->second);
    } else {
      add(entry, KeyUse::ignored, "not a key of CiA 306-3");
    }
  }

  void read_node(const IniEntry& entry, unsigned id, const std::string& what) {
    if (!NodeId::from(id)) {
      add(entry, KeyUse::wrong, "node ids are 1..127");
      wrong(entry.key_pos(), "node-id-range", "node ids are 1..127");
      return;
    }
    auto& node = nodes_[id];
    if (node.pos == SourcePos{}) node.pos = entry.key_pos();
    if (what == "present") {
      node.is_present = values_.read_flag(entry);
      node.present = add(entry, node.is_present ? KeyUse::used : KeyUse::ignored,
                         node.is_present ? "" : "the node is not present; takt left it out");
    } else if (what == "name") {
      node.name = add(entry, KeyUse::used, "name of the node");
    } else if (what == "dcfname") {
      node.dcf = add(entry, KeyUse::used, "device file of the node");
    } else if (what == "refd") {
      add(entry, KeyUse::ignored, "a reference for readers");
    } else {
      add(entry, KeyUse::ignored, "not a key of CiA 306-3");
    }
  }

  void compare_count(const IniSection& topology) {
    const auto listed = static_cast<std::uint32_t>(
        std::ranges::count_if(nodes_, [](const auto& node) { return node.second.is_present; }));
    const bool same = count_ && (*count_ == listed || *count_ == nodes_.size());
    if (same) return;
    const std::string why = "the file lists " + std::to_string(listed) + " nodes as present";
    if (count_row_) {
      rows_[*count_row_].use = KeyUse::suspicious;
      rows_[*count_row_].why = why;
    } else {
      report_.warning(topology.pos, "missing-key", "Nodes is missing; " + why);
    }
  }

  /// Replaces each `\`, which tools for Windows write, with `/`.
  static std::string slashes(std::string text) {
    std::ranges::replace(text, '\\', '/');
    return text;
  }

  void use(unsigned id, ListedNode& node) {
    if (!node.is_present) {
      if (node.present) return;
      report_.warning(node.pos, "missing-key",
                      "Node" + std::to_string(id) + "Present is missing; the node was left out");
      return;
    }
    label(id, node);
    if (!node.dcf) {
      wrong(node.pos, "missing-key",
            fmt::format("node {} has no Node{}DCFName: taktd needs the DCF or EDS of the node", id,
                        id));
      return;
    }
    find_file(id, node);
  }

  void label(unsigned id, ListedNode& node) {
    const std::string otherwise = "node" + std::to_string(id);
    const std::string written = node.name ? rows_[*node.name].value : "";
    node.label = plain_name(written, otherwise);
    if (!labels_.insert(node.label).second) {
      node.label += '_' + std::to_string(id);
      labels_.insert(node.label);
    }
    if (node.name && node.label != written) {
      rows_[*node.name].why = "name of the node, as `" + node.label + '`';
    }
  }

  void find_file(unsigned id, ListedNode& node) {
    ImportedKey& row = rows_[*node.dcf];
    const fs::path name = slashes(row.value);
    std::error_code failed;
    for (const fs::path& path : {cpj_.parent_path() / name, cpj_.parent_path() / base_ / name}) {
      if (row.value.empty() || !fs::is_regular_file(path, failed)) continue;
      node.file = fs::proximate(path, folder_, failed).generic_string();
      if (failed) node.file = path.generic_string();
      take_from(path, id, node, row);
      return;
    }
    row.use = KeyUse::wrong;
    row.why =
        "not found beside the project file" + (base_.empty() ? std::string{} : " or in " + base_);
    wrong(row.pos, "no-file", '`' + row.value + "` " + row.why);
  }

  /// Reads from a DCF its bit rate, and whether this node is the manager of the network.
  void take_from(const fs::path& path, unsigned id, ListedNode& node, ImportedKey& row) {
    const EdsFile file = read_eds_file(path, NodeId::from(id));
    const auto& declared = file.dictionary.commissioning;
    if (declared.node_id && declared.node_id->value() != id) {
      row.use = KeyUse::suspicious;
      row.why = fmt::format("the NodeID of the file is {}; takt uses node id {} of the project",
                            declared.node_id->value(), id);
    }
    if (declared.manager) {
      row.use = KeyUse::ignored;
      row.why = "CANopenManager=1: takt replaces this master";
      master_ = id;
      node.is_present = false;
      return;
    }
    if (declared.baudrate_kbit != 0) bitrates_.insert(declared.baudrate_kbit);
  }

  /// Returns the node-ID of the manager of the project, or else the highest node-ID that no node
  /// has.
  std::optional<unsigned> master_id() const {
    if (master_) return master_;
    for (unsigned id = 127; id > 0; --id) {
      const auto node = nodes_.find(id);
      if (node == nodes_.end() || !node->second.is_present) return id;
    }
    return std::nullopt;
  }

  void write() {
    const auto master = master_id();
    if (!master)
      return wrong({}, "no-free-id", "all 127 node ids are taken: no id is left for takt");
    std::string nodes;
    for (const auto& [id, node] : nodes_) {
      if (!node.is_present) continue;
      nodes += fmt::format("  {}:\n    node_id: {}\n    dcf: {}\n", node.label, id,
                           in_quotes(node.file));
    }
    const std::string bitrate = bitrate_line();
    if (nodes.empty()) return wrong({}, "no-nodes", "no node is present");
    yaml_ = fmt::format(
        "# from {}, [{}]\nbus:\n  name: {}\n{}master:\n  node_id: {}\n"
        "  # sync_period: 10000  # us; without it there is no SYNC\nnodes:\n{}",
        cpj_.filename().string(), to_utf8(title_), plain_name(name_, "bus"), bitrate, *master,
        nodes);
  }

  std::string bitrate_line() {
    if (bitrates_.size() == 1) {
      return fmt::format("  bitrate_kbit: {}  # Baudrate of the DCFs\n", *bitrates_.begin());
    }
    const bool none = bitrates_.empty();
    const unsigned chosen = none ? default_bitrate : *bitrates_.rbegin();
    report_.warning(
        {}, "bitrate",
        fmt::format("{}: `bitrate_kbit` was set to {}; correct this value",
                    none ? "no DCF contains a Baudrate" : "the DCFs differ in Baudrate", chosen));
    return fmt::format("  bitrate_kbit: {}\n", chosen);
  }

  ImportedNodelist finish() {
    ImportedNodelist result;
    result.report.keys = std::move(rows_);
    result.report.others = report_.take();
    result.report.usable = !yaml_.empty() && !wrong_;
    if (result.report.usable) result.yaml = std::move(yaml_);
    return result;
  }

  static constexpr unsigned default_bitrate = 500;

  fs::path cpj_;
  fs::path folder_;
  std::string section_;
  bool is_first_;  // [Topology] may also be named [Topology1]
  Report report_;
  ValueReader values_;
  std::string title_;
  std::string name_;
  std::string base_;
  std::optional<std::uint32_t> count_;
  std::optional<std::size_t> count_row_;
  std::vector<ImportedKey> rows_;
  std::map<unsigned, ListedNode> nodes_;
  std::set<std::string> labels_;
  std::set<std::uint16_t> bitrates_;
  std::optional<unsigned> master_;
  bool wrong_ = false;
  std::string yaml_;
};

}  // namespace

ImportedNodelist import_nodelist(const fs::path& cpj, unsigned number, const fs::path& folder) {
  return Importer{cpj, number, folder}.run();
}

}  // namespace takt
