#include <cstddef>
#include <cstdint>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/network_file/keys/read_devices.hpp"
#include "eds_parser/network_file/keys/read_network.hpp"
#include "eds_parser/plan/network_compiler.hpp"
#include "eds_parser/print/plan/print_plan.hpp"
#include "eds_parser/read/eds.hpp"

namespace {

/// Returns the device for the name of a device file, at one node-ID. Each name selects one of three
/// files, which are read once.
const takt::ObjectDictionary* dictionary_of(const takt::NodeSpec& node) {
  if (!node.dcf.given || !node.id.given) return nullptr;
  constexpr std::string_view files[] = {"takt_drive402.eds", "takt_io401.eds", "lenze8400.eds"};
  static std::map<std::pair<std::size_t, std::uint8_t>, takt::EdsFile> known;
  const std::size_t which = node.dcf->size() % std::size(files);
  auto& file = known[{which, *node.id}];
  if (!file.readable) {
    file = takt::read_eds_file(TAKT_SOURCE_DIR "/share/eds/" + std::string{files[which]},
                               takt::NodeId::from(*node.id));
  }
  return &file.dictionary;
}

const std::vector<takt::DeviceData>& device_data() {
  static const auto data = [] {
    takt::Findings findings;
    return takt::load_device_data({TAKT_SOURCE_DIR "/share/devices"}, findings);
  }();
  return data;
}

}  // namespace

/// Reads any bytes as a network file and as device data, up to the printed plan.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  takt::Findings findings;
  static_cast<void>(takt::read_device_data(text, "fuzz.yaml", findings));
  findings.clear();
  const auto spec = takt::read_network(text, "fuzz.yaml", findings);
  std::vector<const takt::ObjectDictionary*> dictionaries;
  for (const auto& node : spec.nodes) dictionaries.push_back(dictionary_of(node));
  const auto network = takt::compile_network(spec, dictionaries, findings, device_data());
  for (const auto& finding : findings) {
    if (to_string(finding).empty()) __builtin_trap();
  }
  if (takt::has_error(findings)) return 0;
  std::ostringstream out;
  const takt::PlanPrint what{.node = {}, .realtime = spec.realtime, .lcm = spec.lcm};
  takt::print_plan_text(out, network.plan, what);
  takt::print_plan_json(out, network.plan, what);
  return 0;
}
