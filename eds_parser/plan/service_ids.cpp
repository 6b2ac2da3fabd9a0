#include <algorithm>

#include "eds_parser/plan/network_parts.hpp"
#include "eds_parser/plan/sdo_servers.hpp"

namespace takt {
namespace {

constexpr std::uint32_t predefined_time = 0x100;

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
    for (const NodePdos& node : nodes_) servers(node.node);
    return std::move(ids_);
  }

 private:
  void enter(CobId id, const std::string& is, const std::string& key, SourcePos pos) {
    const auto [other, is_new] = ids_.try_emplace(id, is);
    if (is_new) return;
    report_.error(pos, "cob-id-clash", key, " ", id, " ", other->second);
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

  void servers(const NodeSource& node) {
    for (const DeviceSdoServer& server : active_sdo_servers(node)) {
      for (const CobId id : {server.channel.request, server.channel.answer}) {
        if (!of_own_default(node.id, id) && !of_own_channel(*node.spec, id))
          enter(node, server, id);
      }
    }
  }

  void enter(const NodeSource& node, const DeviceSdoServer& server, CobId id) {
    const std::string channel = concat("the SDO channel ", server.index - 0x1200 + 1, " (",
                                       hex(server.index, 4), ") of node `", node.spec->name, "`");
    const bool certain = server.doubt.empty();
    const auto other = ids_.find(id);
    const NodeSource* of_default = other == ids_.end() ? user_of_default(node, id) : nullptr;
    if (other == ids_.end() && certain) ids_.emplace(id, "is in " + channel);
    if (other == ids_.end() && of_default == nullptr) return;
    const std::string whose = of_default != nullptr
                                  ? in_channel_of(*of_default, default_sdo_channel(of_default->id))
                                  : other->second;
    const std::string clash = to_string(id) + " " + whose;
    if (certain) {
      return report_.error(server.pos, "cob-id-clash", channel, " is on: ", clash,
                           switched_off_by(node, server));
    }
    report_.warning(server.pos, "cob-id-clash", channel, " may be on", server.doubt,
                    ", and then the two would collide: ", clash, switched_off_by(node, server));
  }

  static std::string switched_off_by(const NodeSource& node, const DeviceSdoServer& server) {
    const std::string index = hex(server.index, 4);
    const std::string other_id = ", or give one of the nodes another id";
    if (node.dictionary->find(ObjectKey{server.index, 1}) != nullptr) {
      return "; switch it off by `sdo: [{index: " + index + ", sub_index: 1, value: 0x80000000}]`" +
             other_id;
    }
    return "; switch it off in the device (bit 31 of " + index.substr(2) + ":01)" + other_id;
  }

  static bool of_own_channel(const NodeSpec& spec, CobId id) {
    return spec.sdo_channel.given && spec.sdo_channel->has(id);
  }

  static std::string in_channel_of(const NodeSource& node, const SdoChannel& channel) {
    return concat("is in the SDO channel of node `", node.spec->name, "` (", channel.request, ", ",
                  channel.answer, ")");
  }

  static bool of_own_default(NodeId node, CobId id) { return default_sdo_channel(node).has(id); }

  void clash_with_default(const NodeSource& node, CobId id) {
    const NodeSource* other = user_of_default(node, id);
    if (other == nullptr) return;
    report_.error(node.spec->sdo_channel.pos, "cob-id-clash", "`sdo_channel` of `", node.spec->name,
                  "`: ", id, " ", in_channel_of(*other, default_sdo_channel(other->id)));
  }

  /// Returns the other node whose default channel has the identifier `id`. A node uses its default
  /// channel unless another one is configured.
  const NodeSource* user_of_default(const NodeSource& node, CobId id) const {
    const auto other = std::ranges::find_if(nodes_, [&](const NodePdos& one) {
      const bool in_use = one.node.spec != node.spec && !one.node.spec->sdo_channel.given;
      return in_use && of_own_default(one.node.id, id);
    });
    return other == nodes_.end() ? nullptr : &other->node;
  }

  const NetworkSpec& spec_;
  std::span<const NodePdos> nodes_;
  NetworkReport& report_;
  ServiceIds ids_;
};

}  // namespace

std::optional<CobId> emcy_cob_id(const NodeSource& node) {
  const std::int64_t id = node.spec->emcy_cob_id.given
                              ? *node.spec->emcy_cob_id
                              : cob_id_of_file(*node.dictionary, {0x1014, 0});
  const bool off = (id & cob_id_off) != 0;
  if (id <= 0 || off || id == 0x80 + node.id.value()) return std::nullopt;
  return CobId::of_object(static_cast<std::uint32_t>(id));
}

ServiceIds service_ids(const NetworkSpec& spec, std::span<const NodePdos> nodes,
                       NetworkReport& report) {
  return ServiceIdCollector{spec, nodes, report}.run();
}

}  // namespace takt
