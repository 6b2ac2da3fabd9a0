#include <algorithm>

#include "eds_parser/network_file/load_steps.hpp"

namespace takt {
namespace {

template <class To, class From>
void set(Sourced<To>& value, const std::optional<From>& change) {
  if (!change) return;
  value.value = static_cast<To>(*change);
  value.given = true;
}

PdoSpec& pdo_of(NodeSpec& node, const PdoChange& change) {
  auto& pdos = change.tpdo ? node.tpdos : node.rpdos;
  const auto found = std::ranges::find(pdos, change.number, &PdoSpec::number);
  if (found != pdos.end()) return *found;
  PdoSpec& pdo = pdos.emplace_back();
  pdo.number = change.number;
  pdo.pos = node.pos;
  return pdo;
}

void apply(const PdoChange& change, NodeSpec& node) {
  PdoSpec& pdo = pdo_of(node, change);
  set(pdo.transmission, change.transmission);
  set(pdo.sync_start, change.sync_start);
  set(pdo.inhibit_time, change.inhibit_time);
  if (change.cob_id) {
    pdo.cob_id.value = change.cob_id;
    pdo.cob_id.given = true;
  }
  if (change.off) set(pdo.enabled, std::optional{false});
}

std::string no_node(const NetworkSpec& spec, const std::string& name) {
  std::string text = "there is no node `" + name + "` to change; the nodes are";
  for (const auto& node : spec.nodes) text += ' ' + node.name;
  return text;
}

}  // namespace

void apply_changes(const WhatIf& changes, NetworkSpec& spec, Findings& findings) {
  set(spec.master.sync_period_us, changes.sync_period_us);
  set(spec.master.baudrate_kbit, changes.bitrate_kbit);
  set(spec.master.service_frames, changes.service_frames);
  set(spec.master.sync_overflow, changes.sync_overflow);
  for (const auto& change : changes.pdos) {
    const auto node = std::ranges::find(spec.nodes, change.node, &NodeSpec::name);
    if (node != spec.nodes.end()) {
      apply(change, *node);
    } else {
      findings.push_back({spec.file, {}, Severity::error, "what-if", no_node(spec, change.node)});
    }
  }
}

}  // namespace takt
