#include "eds_parser/read/eds.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>

#include "eds_parser/ini/decimal_subs.hpp"
#include "eds_parser/ini/eds_lists.hpp"
#include "eds_parser/ini/eds_section.hpp"
#include "eds_parser/ini/ini.hpp"
#include "eds_parser/ini/value_reader.hpp"
#include "eds_parser/read/compact_pdos.hpp"
#include "eds_parser/read/eds_channels.hpp"
#include "eds_parser/read/eds_info.hpp"
#include "eds_parser/read/eds_objects.hpp"
#include "eds_parser/read/modules.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

/// Larger files are not read. No dictionary of 65,536 objects needs more.
constexpr std::uintmax_t largest_file = 512ULL << 20;

constexpr SourcePos file_start{1, 1};  // place of findings about parts that the file does not have

constexpr std::pair<SectionKind, ObjectList> object_lists[] = {
    {SectionKind::mandatory_objects, ObjectList::mandatory},
    {SectionKind::optional_objects, ObjectList::optional},
    {SectionKind::manufacturer_objects, ObjectList::manufacturer}};

/// The sections of the file by kind.
struct Outline {
  /// The only section of a kind, or nullptr if the file has none.
  const IniSection*& operator[](SectionKind kind) noexcept {
    return single[static_cast<std::size_t>(kind)];
  }

  std::array<const IniSection*, static_cast<std::size_t>(SectionKind::unknown)> single{};
  std::vector<ObjectSection> objects;  ///< in ascending order of index and role, without duplicates
  std::vector<const IniSection*> tools;  ///< [ToolN]
  std::vector<ObjectSection> links;
  /// The number x and the section of each [MxModuleInfo].
  std::vector<std::pair<std::uint16_t, const IniSection*>> modules;
};

class EdsReader {
 public:
  EdsReader(const IniFile& file, Report& report) noexcept
      : file_{file}, report_{report}, modules_{file, report} {}

  EdsFile read(std::string file_name, std::optional<NodeId> node) {
    outline();
    EdsFile result;
    auto& dictionary = result.dictionary;
    dictionary.file = std::move(file_name);
    dictionary.is_dcf = is_dcf(dictionary.file);
    read_headers(dictionary, node);
    read_objects(dictionary);
    expand_compact_pdos(dictionary);
    read_object_links(dictionary);
    result.readable = !dictionary.objects.empty();
    if (!result.readable) {
      report_.error(file_start, "not-an-eds",
                    "the file has no section of an object, for example [1000]: the file is not an "
                    "EDS or DCF");
    }
    return result;
  }

 private:
  void outline() {
    outline_.objects.reserve(file_.sections.size());
    for (std::uint32_t at = 0; at < file_.sections.size(); ++at) {
      place(classify_section(file_.sections[at]), at);
    }
    auto& objects = outline_.objects;
    if (!std::ranges::is_sorted(objects, {}, &ObjectSection::order)) {
      std::ranges::stable_sort(objects, {}, &ObjectSection::order);
    }
    const auto same = [this](const ObjectSection& first, const ObjectSection& second) {
      if (first.order != second.order) return false;
      report_duplicate(file_.sections[first.section], file_.sections[second.section]);
      return true;
    };
    objects.erase(std::unique(objects.begin(), objects.end(), same), objects.end());
  }

  void place(const SectionName& name, std::uint32_t at) {
    const auto& section = file_.sections[at];
    if (name.prefixed) {
      report_.warning(section.pos, "section-name-form", "section ", Quoted{section.name},
                      " is read as the section of an object; CiA 306 writes the index without 0x");
    }
    if (name.leading_zero) {
      report_.note(section.pos, "section-name-form", "section ", Quoted{section.name},
                   ": CiA 306 writes sub-indices without leading zero");
    }
    if (name.blank || section.padded()) report_blank_in_name(section, report_);
    if (is_of_object(name.kind)) return outline_.objects.push_back(ObjectSection::of(name, at));
    switch (name.kind) {
      case SectionKind::object_links:
        outline_.links.push_back(ObjectSection::of(name, at));
        return;
      case SectionKind::commissioning_two_m:
        report_.warning(section.pos, "section-spelling",
                        "CiA 306 spells it [DeviceComissioning], with one m; it was read");
        return keep(SectionKind::commissioning, section);
      case SectionKind::supported_modules:
        return modules_.set_supported(section);
      case SectionKind::connected_modules:
        return modules_.set_connected(section);
      case SectionKind::module:
        if (same_word(name.module_part, "moduleinfo")) {
          outline_.modules.emplace_back(name.module, &section);
        } else if (!modules_.add(name, at)) {
          report_unknown(section);
        }
        return;
      case SectionKind::short_object:
        return;
      case SectionKind::unknown:
        return report_unknown(section);
      default:
        if (name.kind == SectionKind::tools && !same_word(section.name, "tools")) {
          outline_.tools.push_back(&section);
        } else {
          keep(name.kind, section);
        }
    }
  }

  void keep(SectionKind kind, const IniSection& section) {
    const IniSection*& slot = outline_[kind];
    if (slot != nullptr) return report_duplicate(*slot, section);
    slot = &section;
  }

  void report_duplicate(const IniSection& first, const IniSection& second) {
    report_.warning(second.pos, "duplicate-section", "section ", Quoted{second.name},
                    " appears again; the first one, line ", first.pos.line, ", applies");
  }

  void report_unknown(const IniSection& section) {
    report_.warning(section.pos, "unknown-section", "section ", Quoted{section.name},
                    " is not one of CiA 306; it was left out");
  }

  /// The extension of the file name decides. For other extensions than .eds and .dcf, the
  /// section that only a DCF should have decides.
  bool is_dcf(std::string_view name) noexcept {
    const auto extension = name.substr(name.size() - std::min<std::size_t>(name.size(), 4));
    if (same_word(extension, ".dcf")) return true;
    return !same_word(extension, ".eds") && outline_[SectionKind::commissioning] != nullptr;
  }

  /// Returns the entries of the only section of a kind.
  IniEntries entries(SectionKind kind) noexcept {
    const auto* section = outline_[kind];
    return section == nullptr ? IniEntries{} : file_.entries(*section);
  }

  void read_headers(ObjectDictionary& dictionary, std::optional<NodeId> node) {
    ValueReader values{report_, std::nullopt};
    if (const auto* section = outline_[SectionKind::commissioning]) {
      dictionary.commissioning.pos = section->pos;
    }
    read_commissioning(dictionary.commissioning, entries(SectionKind::commissioning), values,
                       report_);
    dictionary.node_id = node ? node : dictionary.commissioning.node_id;
    if (const auto* section = outline_[SectionKind::device_info]) {
      read_device_info(dictionary.device, *section, file_.entries(*section), values, report_);
    } else {
      report_.warning(file_start, "device-info-missing", "the file has no section [DeviceInfo]");
    }
    read_dummy_usage(dictionary.dummy_usage, entries(SectionKind::dummy_usage), values, report_);
    read_channels(dictionary, values);
    read_notes(dictionary);
  }

  void read_channels(ObjectDictionary& dictionary, ValueReader& values) {
    const auto* section = outline_[SectionKind::dynamic_channels];
    const bool supported = dictionary.device.dynamic_channels != 0;
    if (section == nullptr && supported) {
      report_.warning(dictionary.device.pos, "channels-missing",
                      "DynamicChannelsSupported is set, but there is no [DynamicChannels]");
    }
    if (section == nullptr) return;
    if (!supported) {
      report_.note(section->pos, "channels-unsupported",
                   "the file has [DynamicChannels], but DynamicChannelsSupported is 0");
    }
    dictionary.channels =
        read_dynamic_channels(file_.entries(*section), section->pos, values, report_);
  }

  void read_notes(ObjectDictionary& dictionary) {
    read_file_info(dictionary.notes.info, entries(SectionKind::file_info), report_);
    dictionary.notes.comments = read_comments(entries(SectionKind::comments), report_);
    for (const auto* tool : outline_.tools) {
      dictionary.notes.tools.push_back(read_tool(*tool, file_.entries(*tool), report_));
    }
    check_tools(entries(SectionKind::tools), outline_.tools.size(), report_);
    read_modules(dictionary);
  }

  void read_object_links(ObjectDictionary& dictionary) {
    const auto is_described = [&](std::uint16_t index) {
      return dictionary.find(index) != nullptr || modules_.describes(index);
    };
    for (const auto& link : outline_.links) {
      const auto& section = file_.sections[link.section];
      if (!is_described(link.index())) {
        report_list_without_object(section, report_);
        continue;
      }
      auto links = read_links(section, file_.entries(section), is_described, report_);
      const bool is_there = dictionary.find(link.index()) != nullptr;
      if (is_there) dictionary.links.push_back(std::move(links));
    }
  }

  void read_modules(ObjectDictionary& dictionary) {
    std::ranges::stable_sort(outline_.modules, {}, [](const auto& module) { return module.first; });
    for (std::size_t at = 0; at < outline_.modules.size(); ++at) {
      const auto [number, section] = outline_.modules[at];
      if (!dictionary.modules.empty() && dictionary.modules.back().number == number) {
        report_duplicate(*outline_.modules[at - 1].second, *section);
      } else {
        dictionary.modules.push_back(
            read_module_info(number, *section, file_.entries(*section), report_));
      }
    }
  }

  void read_objects(ObjectDictionary& dictionary) {
    const auto described = std::make_unique<IndexSet>();
    for (const auto& section : outline_.objects) {
      if (!section.is_list()) described->set(section.index());
    }
    dictionary.objects.reserve(described->count());
    ObjectLists lists{*described, report_};
    for (const auto& [kind, list] : object_lists) {
      const auto* section = outline_[kind];
      if (section != nullptr) lists.read(list, *section, file_.entries(*section));
    }
    if (!lists.any() && described->any()) {
      report_.warning(file_start, "lists-missing",
                      "the file has no [MandatoryObjects], [OptionalObjects] or "
                      "[ManufacturerObjects]; all sections of objects were read");
    }
    ValueReader values{report_, dictionary.node_id};
    ObjectReader reader{file_, values, report_};
    const std::span all{outline_.objects};
    for (std::size_t at = 0; at < all.size();) {
      std::size_t end = at + 1;
      while (end < all.size() && all[end].index() == all[at].index()) ++end;
      if (all[at].is_list()) {
        report_list_without_object(file_.sections[all[at].section], report_);
      } else {
        auto& object = dictionary.objects.emplace_back(reader.read(all.subspan(at, end - at)));
        object.list = lists.list_of(object.index);
        lists.report_unlisted(object);
      }
      at = end;
    }
    modules_.expand(dictionary, reader);
    modules_.check(dictionary);
    dictionary.domain_files = reader.take_domain_files();
    dictionary.parameter_references = reader.take_references();
    std::ranges::stable_sort(dictionary.parameter_references, {}, &ParameterReference::index);
  }

  const IniFile& file_;
  Report& report_;
  Outline outline_;
  ModuleSections modules_;
};

EdsFile unreadable(std::string file_name, std::string_view message) {
  EdsFile result;
  result.dictionary.file = file_name;
  result.findings.push_back(
      {std::move(file_name), {}, Severity::error, "file-unreadable", std::string{message}});
  return result;
}

}  // namespace

EdsFile read_eds(std::string_view text, std::string file_name, std::optional<NodeId> node) {
  Report report{file_name};
  if (text.size() > largest_file) return unreadable(std::move(file_name), "larger than 512 MB");
  auto file = read_ini(text, report);
  mark_decimal_subs(file, report);
  auto result = EdsReader{file, report}.read(std::move(file_name), node);
  result.findings = report.take();
  return result;
}

EdsFile read_eds_file(const std::filesystem::path& path, std::optional<NodeId> node) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return unreadable(path.string(), error ? error.message() : "is not a regular file");
  }
  const auto size = std::filesystem::file_size(path, error);
  if (error) return unreadable(path.string(), error.message());
  if (size > largest_file) return unreadable(path.string(), "larger than 512 MB");
  std::ifstream stream{path, std::ios::binary};
  std::string text;
  text.resize_and_overwrite(static_cast<std::size_t>(size), [&](char* out, std::size_t room) {
    stream.read(out, static_cast<std::streamsize>(room));
    return static_cast<std::size_t>(stream.gcount());
  });
  if (!stream && !stream.eof()) return unreadable(path.string(), "cannot be read");
  return read_eds(text, path.string(), node);
}

}  // namespace takt
