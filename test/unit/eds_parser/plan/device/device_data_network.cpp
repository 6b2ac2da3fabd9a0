#include "test/unit/eds_parser/plan/device/device_data_network.hpp"

#include <deque>
#include <functional>
#include <gtest/gtest.h>

namespace takt::test {
namespace {

Compiled compile_files(const std::string& yaml, std::span<const DeviceData> entries,
                       const std::function<EdsFile(NodeId)>& read) {
  Compiled out;
  out.spec = read_network(yaml, "net.yaml", out.findings);
  std::deque<EdsFile> files;
  std::vector<const ObjectDictionary*> dictionaries;
  for (const NodeSpec& node : out.spec.nodes) {
    files.push_back(read(*NodeId::from(*node.id)));
    dictionaries.push_back(&files.back().dictionary);
  }
  CompiledNetwork compiled = compile_network(out.spec, dictionaries, out.findings, entries);
  out.plan = std::move(compiled.plan);
  out.devices = std::move(compiled.devices);
  return out;
}

}  // namespace

const std::vector<DeviceData>& shipped_device_data() {
  static const std::vector<DeviceData> entries = [] {
    Findings findings;
    auto all = load_device_data({TAKT_SOURCE_DIR "/share/devices"}, findings);
    for (const Finding& finding : findings) ADD_FAILURE() << to_string(finding);
    return all;
  }();
  return entries;
}

Compiled compile_device_file(const std::string& yaml, const std::string& eds,
                             std::span<const DeviceData> entries) {
  return compile_files(yaml, entries, [&](NodeId id) {
    return read_eds_file(TAKT_SOURCE_DIR "/share/eds/" + eds, id);
  });
}

Compiled compile_with_shipped(const std::string& yaml, const std::string& eds) {
  return compile_files(yaml, shipped_device_data(),
                       [&](NodeId id) { return read_eds(eds, "tiny.eds", id); });
}

Compiled drv28(const std::string& rest) {
  return compile_device_file(
      "master: {sync_period: 10000}\npump: {node_id: 4, dcf: x, " + rest + "}\n",
      "astraada_drv28.eds");
}

Compiled lenze8400(const std::string& rest) {
  return compile_device_file("drive: {node_id: 3, dcf: x, " + rest + "}\n", "lenze8400.eds");
}

std::optional<DeviceData> read_entry(const std::string& text, Findings& findings) {
  return read_device_data(text, "my_drive.yaml", findings);
}

Compiled compile_with_entry(const std::string& entry, const std::string& yaml,
                            const std::string& eds, const std::string& file) {
  Findings findings;
  const auto data = read_entry(entry, findings);
  for (const Finding& finding : findings) ADD_FAILURE() << to_string(finding);
  if (!data) return {};
  return compile_files(yaml, std::span{&*data, 1},
                       [&](NodeId id) { return read_eds(eds, file, id); });
}

std::vector<std::string> errors_of_entry(const std::string& text) {
  Findings findings;
  EXPECT_FALSE(read_entry(text, findings)) << text;
  std::vector<std::string> lines;
  for (const Finding& finding : findings) {
    lines.push_back(std::to_string(finding.pos.line) + " " + std::string{finding.rule});
  }
  return lines;
}

std::vector<BootStep> steps_of(const Compiled& net, ObjectKey key) {
  std::vector<BootStep> found;
  for (const BootStep& step : net.plan.nodes.at(0).boot_plan.steps) {
    if (step.object == key) found.push_back(step);
  }
  return found;
}

}  // namespace takt::test
