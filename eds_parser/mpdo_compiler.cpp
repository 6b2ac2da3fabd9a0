#include "eds_parser/mpdo_compiler.hpp"

#include <algorithm>

#include "eds_parser/mapping_compiler.hpp"

namespace takt {
namespace {

constexpr unsigned data_bits = 32;  ///< bytes 4..7
constexpr std::uint32_t destination_flag = 0x80;

class MpdoCompiler {
 public:
  MpdoCompiler(const NodeSource& node, const EffectivePdo& pdo, NetworkReport& report)
      : node_{node}, pdo_{pdo}, report_{report} {}

  std::optional<EffectiveEntry> entry(const MappingSpec& wanted) {
    const bool of_master = pdo_.is_tpdo && pdo_.mpdo == Mpdo::dam;
    const SubObject* sub = of_master ? nullptr : node_.dictionary->find(wanted.object);
    if (sub == nullptr && !of_master) {
      error(wanted, "no-such-object",
            "object " + to_string(wanted.object) + " is not in " + node_.dictionary->file);
      return {};
    }
    EffectiveEntry out{.object = wanted.object,
                       .bits = wanted.bits.value_or(0),
                       .bit_offset = data_bits,
                       .dummy = false,
                       .type = of_master ? DataType::unsigned32 : sub->type,
                       .name = of_master ? "object " + to_string(wanted.object)
                                         : object_name(*node_.dictionary, wanted.object),
                       .pos = wanted.pos};
    if (out.bits == 0) out.bits = static_cast<std::uint8_t>(bit_width(out.type));
    if (out.bits != 0 && out.bits <= data_bits) return out;
    error(wanted, "wrong-width",
          "object " + to_string(wanted.object) +
              " does not fit: a multiplexed PDO carries up to 32 "
              "bits");
    return {};
  }

 private:
  void error(const MappingSpec& wanted, std::string_view rule, const std::string& text) {
    report_.error(wanted.pos, rule, pdo_.label() + " of node `" + node_.spec->name + "`: " + text);
  }

  const NodeSource& node_;
  const EffectivePdo& pdo_;
  NetworkReport& report_;
};

}  // namespace

std::vector<EffectiveEntry> compile_mpdo(const NodeSource& node, const EffectivePdo& pdo,
                                         const Sourced<std::vector<MappingSpec>>& wanted,
                                         NetworkReport& report) {
  std::vector<EffectiveEntry> entries;
  MpdoCompiler compiler{node, pdo, report};
  for (const MappingSpec& spec : *wanted) {
    auto entry = compiler.entry(spec);
    if (!entry) continue;
    if (std::ranges::find(entries, entry->object, &EffectiveEntry::object) != entries.end()) {
      report.error(spec.pos, "mapped-twice",
                   pdo.label() + " of node `" + node.spec->name + "` lists " +
                       to_string(spec.object) + " twice");
      continue;
    }
    entries.push_back(std::move(*entry));
  }
  return entries;
}

std::uint32_t mpdo_header(const EffectivePdo& pdo, const EffectiveEntry& entry, NodeId device,
                          NodeId master) noexcept {
  std::uint32_t address = device.value();
  if (pdo.mpdo == Mpdo::dam) {
    address = destination_flag | (pdo.is_tpdo ? master.value() : device.value());
  }
  return address | std::uint32_t{entry.object.index} << 8 | std::uint32_t{entry.object.sub} << 24;
}

}  // namespace takt
