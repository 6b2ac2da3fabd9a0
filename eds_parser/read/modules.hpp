#pragma once
#include <cstdint>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/ini/ini.hpp"
#include "eds_parser/read/eds_objects.hpp"
#include "eds_parser/read/module_lists.hpp"
#include "eds_parser/report/report.hpp"

namespace takt {

/// The sections of a modular device: the objects of each module type, and the modules that are
/// plugged in. CiA 306, 6.
class ModuleSections {
 public:
  ModuleSections(const IniFile& file, Report& report) noexcept : file_{file}, report_{report} {}

  /// Adds a section [Mx...]. Only fixed objects, sub-index extensions and the lists of both are
  /// used; other sections of CiA 306 are ignored. Returns false if the section is not one of CiA
  /// 306.
  bool add(const SectionName& name, std::uint32_t section);
  void set_supported(const IniSection& section) noexcept { lists_.set_supported(section); }
  void set_connected(const IniSection& section) noexcept { connected_ = &section; }

  /// Adds the objects of the connected modules to a dictionary, in physical order. Without
  /// [ConnectedModules], as in an EDS, no module is plugged in.
  void expand(ObjectDictionary& dictionary, ObjectReader& reader);
  /// Returns true if a section of any module, connected or not, describes this object.
  bool describes(std::uint16_t index) const { return indices_.contains(index); }
  /// Checks the lists, and reads the sections of modules that are not connected for their findings
  /// only. Call this after expand().
  void check(const ObjectDictionary& dictionary);

 private:
  using Part = ModulePart;

  struct ModuleSection {
    std::uint16_t module = 0;
    Part part = Part::fixed;
    ObjectSection object;

    auto order() const noexcept { return std::tuple{module, part, object.order}; }
  };

  struct Slot {
    std::uint32_t number = 0;
    IniEntry entry;
  };

  class Expansion;

  std::vector<Slot> slots() const;
  std::vector<std::uint16_t> connected_types() const;
  std::span<const ModuleSection> sections_of(std::uint16_t module, Part part) const;
  SubExtension read_extension(const ModuleSection& section, ObjectReader& reader) const;

  const IniFile& file_;
  Report& report_;
  const IniSection* connected_ = nullptr;
  std::vector<ModuleSection> sections_;
  std::set<std::uint16_t> indices_;  ///< indices that `sections_` describe
  ModuleLists lists_;
};

}  // namespace takt
