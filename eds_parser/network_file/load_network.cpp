#include "eds_parser/network_file/load_network.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <system_error>
#include <tuple>

#include "eds_parser/budget/budget.hpp"
#include "eds_parser/check/check.hpp"
#include "eds_parser/dictionary/concise_dcf.hpp"
#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/network_file/changed_network.hpp"
#include "eds_parser/network_file/keys/read_devices.hpp"
#include "eds_parser/network_file/keys/read_network.hpp"
#include "eds_parser/network_file/load_steps.hpp"
#include "eds_parser/network_file/yaml/yaml_tree.hpp"
#include "eds_parser/plan/network_compiler.hpp"
#include "eds_parser/read/eds.hpp"
#include "eds_parser/values/little_endian.hpp"

namespace takt {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_program = std::size_t{16} << 20U;
constexpr std::size_t max_configuration = std::size_t{1} << 20U;

/// Returns a text that says why a path can't be read as a network file, and which path to name
/// instead.
std::string why_unreadable(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return "is a folder; name the network file (YAML) in it";
  if (!fs::exists(status)) return "there is no such file";
  if (!fs::is_regular_file(status)) return "is not a regular file";
  return "can't be read: no permission";
}

/// Returns for example `1 error` or `2 errors`.
std::string counted(std::ptrdiff_t count, const std::string& what) {
  return concat(count, " ", what, count == 1 ? "" : "s");
}

/// If at least this number of listed objects have no section, the file is probably cut off and not
/// only edited carelessly.
constexpr std::ptrdiff_t torn_from = 8;

class Loader {
 public:
  Loader(const fs::path& path, DeviceDataUse use) : path_{path}, use_{use} {}

  LoadedNetwork run(const WhatIf& changes) {
    const auto text = read_limited_file(path_);
    if (!text) {
      error({}, "no-file", why_unreadable(path_));
      return std::move(out_);
    }
    NetworkSpec spec = read_network(*text, path_.string(), out_.findings);
    apply_changes(changes, spec, out_.findings);
    note_placeholder(spec);
    for (NodeSpec& node : spec.nodes) read_node_files(spec, node);
    std::vector<const ObjectDictionary*> dictionaries;
    for (const NodeSpec& node : spec.nodes) dictionaries.push_back(dictionary_of(spec, node));
    std::vector<DeviceData> device_data;
    if (use_ == DeviceDataUse::applied) {
      device_data = load_device_data(device_folders(), out_.findings);
    }
    CompiledNetwork compiled = compile_network(spec, dictionaries, out_.findings, device_data);
    out_.plan = std::move(compiled.plan);
    for (const NodePlan& node : out_.plan.nodes) out_.device_files.push_back(paths_[node.name]);
    if (!spec.master.service_frames.given) lower_service_frames();
    out_.devices = std::move(compiled.devices);
    out_.realtime = spec.realtime;
    out_.lcm = spec.lcm;
    out_.recording = spec.recording;
    if (!spec.recording.folder.empty()) {
      out_.recording.folder = (path_.parent_path() / spec.recording.folder).string();
    }
    out_.bus_named = spec.bus.name.given || spec.bus.interface.given;
    sort_findings(spec);
    return std::move(out_);
  }

 private:
  template <class... Parts>
  void error(SourcePos pos, std::string_view rule, const Parts&... parts) {
    add(Severity::error, pos, rule, parts...);
  }
  template <class... Parts>
  void add(Severity severity, SourcePos pos, std::string_view rule, const Parts&... parts) {
    out_.findings.push_back({path_.string(), pos, severity, rule, concat(parts...)});
  }

  /// Lowers the default of `service_frames` until all frames fit on the bus. Keeps the default if
  /// no number is low enough.
  void lower_service_frames() {
    if (has_error(out_.findings)) return;
    std::uint16_t& frames = out_.plan.cycle.service_frames;
    frames = fitting_service_frames(out_.plan).value_or(frames);
  }

  static bool is_placeholder(const std::string& path) {
    return path.find('@') != std::string::npos;
  }

  /// Notes the use of `@BUS_CONFIG_PATH@`, which the build of ros2_canopen fills in. takt looks for
  /// the files beside the network file instead.
  void note_placeholder(const NetworkSpec& spec) {
    if (!spec.dcf_path.given || !is_placeholder(*spec.dcf_path)) return;
    add(Severity::note, spec.dcf_path.pos, "placeholder", "`dcf_path` ", *spec.dcf_path,
        " is a placeholder of another build system: takt looks for files beside this file");
  }

  /// Turns `@BUS_CONFIG_PATH@/x.eds` into `x.eds`.
  static std::string without_placeholder(const std::string& name) {
    const auto end = name.starts_with('@') ? name.find("@/", 1) : std::string::npos;
    return end == std::string::npos ? name : name.substr(end + 2);
  }

  /// Returns the paths at which a file of a node may be: beside the network file, then in
  /// `dcf_path` of the node, then in that of `options`.
  std::vector<fs::path> candidates(const NetworkSpec& spec, const NodeSpec& node,
                                   const std::string& written) const {
    const fs::path folder = path_.parent_path();
    const std::string name = without_placeholder(written);
    std::vector<fs::path> paths{folder / name};
    for (const auto& extra : {node.dcf_path, spec.dcf_path}) {
      if (extra.given && !is_placeholder(*extra)) paths.push_back(folder / *extra / name);
    }
    return paths;
  }

  /// Removes `x/..` from a path if the result names the same file. The result may name another file
  /// if `x` is a symbolic link.
  static fs::path tidy(const fs::path& path) {
    std::error_code error;
    fs::path plain = path.lexically_normal();
    return fs::equivalent(path, plain, error) && !error ? plain : path;
  }

  static const fs::path* existing(const std::vector<fs::path>& paths) {
    std::error_code ignored;
    const auto found = std::ranges::find_if(
        paths, [&](const fs::path& path) { return fs::is_regular_file(path, ignored); });
    return found == paths.end() ? nullptr : &*found;
  }

  void read_node_files(const NetworkSpec& spec, NodeSpec& node) {
    if (const auto bytes = read_bytes(spec, node, node.software_file, max_program)) {
      node.program = *bytes;
    }
    const auto concise = read_bytes(spec, node, node.configuration_file, max_configuration);
    if (!concise) return;
    const auto entries = decode_concise_dcf(*concise);
    if (!entries) {
      return error(
          node.configuration_file.pos, "concise-dcf", "`", *node.configuration_file, "` ",
          entries.error(),
          ": `configuration_file` needs a concise DCF (0x1F22); write a DCF in text under `dcf`");
    }
    std::vector<SdoSpec> values;
    for (const ConciseEntry& entry : *entries) values.push_back(sdo_of(entry, node));
    node.sdo.insert(node.sdo.begin(), values.begin(), values.end());
  }

  /// Converts an entry of a concise DCF. The values of PDO parameters become numbers, because they
  /// are merged into the configuration of the PDOs.
  static SdoSpec sdo_of(const ConciseEntry& entry, const NodeSpec& node) {
    SdoSpec sdo{.object = entry.object,
                .value = entry.value,
                .pos = node.configuration_file.pos,
                .value_pos = node.configuration_file.pos};
    if (is_pdo_parameter(entry.object.index) && entry.value.size() <= 8) {
      sdo.value = static_cast<std::int64_t>(from_little_endian(entry.value));
    }
    return sdo;
  }

  std::optional<std::vector<std::byte>> read_bytes(const NetworkSpec& spec, const NodeSpec& node,
                                                   const Sourced<std::string>& file,
                                                   std::size_t limit) {
    if (!file.given) return std::nullopt;
    const std::vector<fs::path> paths = candidates(spec, node, *file);
    const fs::path* path = existing(paths);
    std::error_code ignored;
    if (path == nullptr || fs::file_size(*path, ignored) > limit) {
      error(file.pos, "no-file", "node `", node.name, "`: file `", *file, "` ",
            path == nullptr ? "not found beside the network file or in `dcf_path`"
                            : concat("larger than ", limit, " bytes"));
      return std::nullopt;
    }
    std::ifstream in{*path, std::ios::binary};
    const std::string text{std::istreambuf_iterator<char>{in}, {}};
    const auto bytes = std::as_bytes(std::span{text});
    return std::vector<std::byte>{bytes.begin(), bytes.end()};
  }

  const ObjectDictionary* dictionary_of(const NetworkSpec& spec, const NodeSpec& node) {
    if (!node.dcf.given) return nullptr;
    const std::vector<fs::path> paths = candidates(spec, node, *node.dcf);
    if (const fs::path* found = existing(paths)) {
      std::error_code error;
      const fs::path path = tidy(*found);
      const fs::path absolute = fs::canonical(path, error);
      if (!error) paths_[node.name] = absolute.string();
      return read(path, node);
    }
    report_missing(node, paths);
    return nullptr;
  }

  void report_missing(const NodeSpec& node, const std::vector<fs::path>& paths) {
    std::string where;
    std::string what = "not found; looked for ";
    std::error_code ignored;
    for (const fs::path& path : paths) {
      where += (where.empty() ? "" : ", ") + path.lexically_normal().string();
      if (fs::is_directory(path, ignored)) {
        what = "is a folder: name the EDS or DCF file in it; looked for ";
      } else if (fs::exists(path, ignored)) {
        what = "is not a regular file; looked for ";
      }
    }
    error(node.dcf.pos, "no-device-file", "node `", node.name, "`: device file `", *node.dcf, "` ",
          what, where);
  }

  const ObjectDictionary* read(const fs::path& path, const NodeSpec& node) {
    const auto id = node.id.given ? NodeId::from(*node.id) : std::nullopt;
    const auto key = std::pair{path, id ? id->value() : std::uint8_t{0}};
    const auto known = files_.find(key);
    if (known != files_.end()) return known->second.readable ? &known->second.dictionary : nullptr;
    EdsFile& file = files_[key];
    file = read_eds_file(path, id);
    if (!file.readable) {
      const std::size_t before = out_.findings.size();
      std::ranges::copy_if(file.findings, std::back_inserter(out_.findings), [](const Finding& f) {
        // All other findings only follow from the errors. A binary file, for example, has hundreds
        // of them.
        return f.severity == Severity::error;
      });
      const bool reported = out_.findings.size() != before;
      add(reported ? Severity::note : Severity::error, node.dcf.pos, "no-device-file", "node `",
          node.name, "`: `", *node.dcf, "` can't be read as an EDS or DCF");
      return nullptr;
    }
    add_device_finding(path, file, id);
    read_domain_files(path, file.dictionary, out_.findings);
    return &file.dictionary;
  }

  /// Errors in a device file do not make the network file wrong; `takt eds check` lists them. If
  /// several nodes share a device file, it is reported once, with the findings of the first node.
  void add_device_finding(const fs::path& path, const EdsFile& file, std::optional<NodeId> id) {
    if (!reported_.insert(path).second) return;
    const Findings judged = check(file.dictionary);
    const auto count = [&](Severity severity) {
      return std::ranges::count(file.findings, severity, &Finding::severity) +
             std::ranges::count(judged, severity, &Finding::severity);
    };
    const auto errors = count(Severity::error);
    const auto warnings = count(Severity::warning);
    if (errors + warnings == 0) return;
    const auto listed_only =
        std::ranges::count(file.findings, "listed-without-section", &Finding::rule);
    out_.findings.push_back(
        {path.string(),
         {},
         errors > 0 || listed_only >= torn_from ? Severity::warning : Severity::note,
         "device-file",
         concat(counted(errors, "error"), " and ", counted(warnings, "warning"),
                " in this device file",
                listed_only < torn_from
                    ? ""
                    : concat("; ", listed_only,
                             " objects that it lists have no section: is the file cut off?"),
                "; `takt eds check ", id ? concat("--node ", id->value(), " ") : "", path.string(),
                "` lists them")});
  }

  /// Sorts findings: device files first, then the network file by position. A finding that nodes
  /// share is reported once.
  void sort_findings(const NetworkSpec& spec) {
    const std::string own = path_.string();
    std::ranges::stable_sort(out_.findings, {}, [&](const Finding& finding) {
      return std::tuple{finding.file == own, finding.file == own ? finding.pos : SourcePos{}};
    });
    drop_consequences();
    std::set<std::tuple<std::string, SourcePos, std::string>> seen;
    std::erase_if(out_.findings, [&](const Finding& finding) {
      return !seen.emplace(finding.file, finding.pos, finding.message).second;
    });
    std::vector<std::string> names;
    for (const NodeSpec& node : spec.nodes) names.push_back(node.name);
    join_shared_lines(out_.findings, own, names);
  }

  /// Drops findings that only follow from the value of `sync_period` if that value itself is wrong.
  void drop_consequences() {
    const bool wrong_period = std::ranges::any_of(out_.findings, [](const Finding& finding) {
      return finding.severity == Severity::error && finding.rule != "does-not-fit" &&
             finding.message.starts_with("`sync_period`");
    });
    if (!wrong_period) return;
    std::erase_if(out_.findings, [](const Finding& finding) {
      return finding.rule == "no-sync" || finding.rule == "does-not-fit";
    });
  }

  fs::path path_;
  DeviceDataUse use_;
  LoadedNetwork out_;
  std::map<std::pair<fs::path, std::uint8_t>, EdsFile> files_;  // elements keep their addresses
  std::set<fs::path> reported_;
  std::map<std::string, std::string> paths_;  // absolute paths of the device files, by node
};

}  // namespace

LoadedNetwork load_network(const fs::path& path, DeviceDataUse device_data) {
  return Loader{path, device_data}.run({});
}

LoadedNetwork load_changed_network(const fs::path& path, const WhatIf& changes) {
  return Loader{path, DeviceDataUse::applied}.run(changes);
}

}  // namespace takt
