#include <algorithm>
#include <takt/network.hpp>
#include <utility>

#include "apps/master/network_state.hpp"

namespace takt {
namespace {

NetworkFinding to_public(const Finding& finding) {
  return {.file = finding.file,
          .line = finding.pos.line,
          .column = finding.pos.column,
          .error = finding.severity == Severity::error,
          .rule = finding.rule,
          .text = to_string(finding)};
}

NetworkNode to_public(const NodePlan& node) {
  return {.name = node.name,
          .id = node.id.value(),
          .product = node.product_name,
          .mandatory = node.mandatory};
}

ImageSignal to_public(const Signal& signal, const BusPlan& plan) {
  return {.node = plan.nodes[signal.node_index].name,
          .node_id = signal.node.value(),
          .name = signal.name,
          .index = signal.object.index,
          .sub = signal.object.sub,
          .bits = signal.bits,
          .output = signal.output,
          .scale = signal.scale,
          .offset = signal.offset,
          .unit = signal.unit};
}

enum class Direction : bool { input, output };

std::optional<std::size_t> find(const std::vector<ImageSignal>& signals, std::string_view node,
                                ObjectKey object, Direction direction) noexcept {
  const auto found = std::ranges::find_if(signals, [&](const ImageSignal& signal) {
    return signal.output == (direction == Direction::output) && signal.node == node &&
           signal.index == object.index && signal.sub == object.sub;
  });
  if (found == signals.end()) return std::nullopt;
  return static_cast<std::size_t>(found - signals.begin());
}

}  // namespace

NetworkFile NetworkFile::load(const std::filesystem::path& path) {
  auto state = std::make_unique<State>();
  state->loaded = load_network(path);
  const BusPlan& plan = state->loaded.plan;
  for (const Finding& finding : state->loaded.findings) {
    state->findings.push_back(to_public(finding));
  }
  for (const NodePlan& node : plan.nodes) state->nodes.push_back(to_public(node));
  for (const Signal& signal : plan.layout.signals) {
    state->signals.push_back(to_public(signal, plan));
  }
  return NetworkFile{std::move(state)};
}

NetworkFile::NetworkFile(std::unique_ptr<State> state) noexcept : state_{std::move(state)} {}
NetworkFile::~NetworkFile() = default;
NetworkFile::NetworkFile(NetworkFile&& other) noexcept = default;
NetworkFile& NetworkFile::operator=(NetworkFile&& other) noexcept = default;

bool NetworkFile::usable() const noexcept { return !has_error(state_->loaded.findings); }
const std::vector<NetworkFinding>& NetworkFile::findings() const noexcept {
  return state_->findings;
}
const std::string& NetworkFile::bus() const noexcept { return state_->loaded.plan.name; }
const std::string& NetworkFile::interface() const noexcept { return state_->loaded.plan.interface; }
std::chrono::nanoseconds NetworkFile::period() const noexcept {
  return state_->loaded.plan.cycle.period;
}
const std::vector<NetworkNode>& NetworkFile::nodes() const noexcept { return state_->nodes; }
const std::vector<ImageSignal>& NetworkFile::signals() const noexcept { return state_->signals; }

std::optional<std::size_t> NetworkFile::find_input(std::string_view node, std::uint16_t index,
                                                   std::uint8_t sub) const noexcept {
  return find(state_->signals, node, {index, sub}, Direction::input);
}

std::optional<std::size_t> NetworkFile::find_output(std::string_view node, std::uint16_t index,
                                                    std::uint8_t sub) const noexcept {
  return find(state_->signals, node, {index, sub}, Direction::output);
}

}  // namespace takt
