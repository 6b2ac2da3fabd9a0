#include <algorithm>
#include <string_view>

#include "eds_parser/plan/network_parts.hpp"
#include "eds_parser/report/suggest.hpp"

namespace takt {
namespace {

void check_producer(const NodeSource& node, SourcePos pos, NetworkReport& report) {
  if (!*node.spec->boot) return;  // Another tool configures the node.
  for (const ObjectKey key : {ObjectKey{0x1005, 0}, ObjectKey{0x1006, 0}}) {
    const SubObject* object = node.dictionary->find(key);
    if (object != nullptr && object->is_writable()) continue;
    report.error(pos, "sync-source", "node `", node.spec->name,
                 "` can't produce SYNC: ", node.dictionary->file, " does not have ", key,
                 " as a writable object");
    return;
  }
}

}  // namespace

void compile_sync_source(const NetworkSpec& spec, const std::vector<NodePdos>& nodes, BusPlan& plan,
                         NetworkReport& report) {
  const Sourced<std::string>& source = spec.master.sync_source;
  CyclePlan& cycle = plan.cycle;
  if (!source.given || *source == "master" || !cycle.sync) return;
  cycle.sync_followed = true;
  cycle.on_sync_loss = *spec.master.on_sync_loss;
  cycle.sync_timeout = spec.master.sync_timeout_us.given
                           ? std::chrono::microseconds{*spec.master.sync_timeout_us}
                           : cycle.period + cycle.period / 2;
  if (*source == "external") return;
  const auto named = [&](const NodePdos& node) { return node.node.spec->name == *source; };
  const auto found = std::ranges::find_if(nodes, named);
  if (found != nodes.end()) {
    cycle.sync_producer = found->node.id;
    check_producer(found->node, source.pos, report);
    return;
  }
  if (std::ranges::find(spec.nodes, *source, &NodeSpec::name) != spec.nodes.end()) return;
  std::vector<std::string_view> names{"master", "external"};
  for (const NodeSpec& node : spec.nodes) names.push_back(node.name);
  const std::string hint = did_you_mean(*source, names);
  report.error(source.pos, "sync-source", "`sync_source: ", *source, "`: there is no such node",
               hint, hint.empty() ? "; a" : " A",
               " device outside of this file has the name `external`");
}

}  // namespace takt
