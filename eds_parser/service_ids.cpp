#include "eds_parser/service_ids.hpp"

#include <algorithm>
#include <cctype>

#include "eds_parser/integer_of.hpp"

namespace takt {
namespace {

constexpr std::uint32_t predefined_time = 0x100;
constexpr std::uint32_t emcy_off = 0x8000'0000;
constexpr std::uint32_t extended_flag = 0x2000'0000;

bool is_relative(const SubObject& sub) {
  constexpr std::string_view formula = "$nodeid";
  const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  return !std::ranges::search(sub.default_text, formula, same).empty();
}

/// A plain number as the default of an EDS is that of the node it was taken from.
std::int64_t emcy_of_file(const ObjectDictionary& dictionary) {
  const SubObject* sub = dictionary.find(ObjectKey{0x1014, 0});
  if (sub == nullptr) return 0;
  const bool configured = dictionary.is_dcf && sub->parameter_value;
  const std::int64_t id =
      integer_of(configured ? sub->parameter_value : sub->default_value).value_or(0);
  const bool meant = configured || is_relative(*sub) || (id & extended_flag) != 0;
  return meant ? id : 0;
}

class ServiceIdCollector {
 public:
  ServiceIdCollector(const NetworkSpec& spec, std::span<const NodePdos> nodes,
                     NetworkReport& report)
      : spec_{spec}, nodes_{nodes}, report_{report} {}

  ServiceIds run() {
    const MasterSpec& master = spec_.master;
    enter(CobId::base(*master.sync_cob_id), "is SYNC", "`sync_cob_id`", master.sync_cob_id.pos);
    enter(CobId::base(*master.time_cob_id & 0x7FF), "is TIME", "`time_cob_id`",
          master.time_cob_id.pos);
    ids_.try_emplace(CobId::base(predefined_time), "is TIME");
    for (const NodePdos& node : nodes_) emcy(node.node);
    for (const NodePdos& node : nodes_) channel(node.node);
    return std::move(ids_);
  }

 private:
  void enter(CobId id, std::string is, const std::string& key, SourcePos pos) {
    const auto [other, is_new] = ids_.try_emplace(id, std::move(is));
    if (is_new) return;
    report_.error(pos, "cob-id-clash", key + " " + to_string(id) + " " + other->second);
  }

  void emcy(const NodeSource& node) {
    const std::string whose = " of `" + node.spec->name + "`";
    const CobId id = emcy_cob_id(node).value_or(CobId::base(0x80U + node.id.value()));
    const bool given = node.spec->emcy_cob_id.given;
    enter(id, "is EMCY of node `" + node.spec->name + "`",
          (given ? "`emcy_cob_id`" : "EMCY (1014)") + whose,
          given ? node.spec->emcy_cob_id.pos : node.spec->pos);
  }

  void channel(const NodeSource& node) {
    if (!node.spec->sdo_channel.given) return;
    const SdoChannel& channel = *node.spec->sdo_channel;
    const std::string is = in_channel_of(node, channel);
    for (const CobId id : {channel.request, channel.answer}) {
      if (of_own_default(node.id, id)) continue;
      enter(id, is, "`sdo_channel` of `" + node.spec->name + "`", node.spec->sdo_channel.pos);
      clash_with_default(node, id);
    }
  }

  static std::string in_channel_of(const NodeSource& node, const SdoChannel& channel) {
    return "is in the SDO channel of node `" + node.spec->name + "` (" +
           to_string(channel.request) + ", " + to_string(channel.answer) + ")";
  }

  static bool of_own_default(NodeId node, CobId id) {
    const SdoChannel own = default_sdo_channel(node);
    return id == own.request || id == own.answer;
  }

  /// The channel that every device has stays in use where no other one is configured.
  void clash_with_default(const NodeSource& node, CobId id) {
    for (const NodePdos& other : nodes_) {
      if (other.node.spec == node.spec || other.node.spec->sdo_channel.given) continue;
      if (!of_own_default(other.node.id, id)) continue;
      report_.error(node.spec->sdo_channel.pos, "cob-id-clash",
                    "`sdo_channel` of `" + node.spec->name + "`: " + to_string(id) + " " +
                        in_channel_of(other.node, default_sdo_channel(other.node.id)));
    }
  }

  const NetworkSpec& spec_;
  std::span<const NodePdos> nodes_;
  NetworkReport& report_;
  ServiceIds ids_;
};

}  // namespace

std::optional<CobId> emcy_cob_id(const NodeSource& node) {
  const std::int64_t id =
      node.spec->emcy_cob_id.given ? *node.spec->emcy_cob_id : emcy_of_file(*node.dictionary);
  const bool off = (id & emcy_off) != 0;
  if (id <= 0 || off || id == 0x80 + node.id.value()) return std::nullopt;
  const auto raw = static_cast<std::uint32_t>(id);
  return (raw & extended_flag) != 0 ? CobId::extended(raw) : CobId::base(raw);
}

ServiceIds service_ids(const NetworkSpec& spec, std::span<const NodePdos> nodes,
                       NetworkReport& report) {
  return ServiceIdCollector{spec, nodes, report}.run();
}

}  // namespace takt
