#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <string_view>

#include "apps/takt/learn/device_files.hpp"
#include "apps/takt/learn/network_text.hpp"
#include "apps/takt/learn/recording.hpp"
#include "eds_parser/network_file/keys/read_network.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/read/eds.hpp"
#include "master/explain/frame/error_frame_text.hpp"
#include "master/explain/frame/frame_text.hpp"
#include "master/trace/recorded_lines.hpp"
#include "master/trace/trace_line.hpp"
#include "test/fuzz/input.hpp"

namespace {

using takt::fuzz::demand;

const takt::LoadedNetwork& network() {
  static const auto loaded = takt::load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml");
  return loaded;
}

/// Does with each line what `takt dump` does. The result, printed as a line of candump, must give
/// the same frame.
void dump(std::string_view text) {
  takt::FrameText alone;
  takt::FrameText named{network().plan, network().devices};
  takt::RecordedLines lines;
  std::istringstream in{std::string{text}};
  for (std::string line; std::getline(in, line);) {
    const auto found = lines.parse(line);
    if (!found) {
      static_cast<void>(takt::is_remark(line));
      continue;
    }
    demand(found->frame.length <= 8);
    if (found->error_frame) {
      static_cast<void>(takt::error_frame_text(found->frame.id.id(), found->frame.payload()));
      continue;
    }
    demand(!alone.meaning(found->frame).service.empty());
    static_cast<void>(named.meaning(found->frame));
    if (!found->stamp.empty() || found->interface.empty()) continue;
    const auto again = takt::parse_candump(takt::to_string(*found));
    demand(again && again->frame == found->frame);
  }
}

/// Does with the whole text what `takt learn` does. The resulting network file and EDS files are
/// read again.
void learn(std::string_view text) {
  std::istringstream in{std::string{text}};
  const takt::learn::LearnedBus bus = takt::learn::read_recording(in, "fuzz.log", {});
  for (const takt::Finding& finding : bus.findings) demand(!to_string(finding).empty());
  const auto learned = takt::learn::learned_network(bus, takt::learn::DeviceFiles{}, {});
  takt::Findings findings;
  static_cast<void>(takt::read_network(learned.text, "learned.yaml", findings));
  for (const auto& [name, content] : learned.made_files) {
    demand(takt::read_eds(content, name, takt::NodeId::from(5)).readable);
  }
}

}  // namespace

/// Reads any bytes as a recording of candump, a PCAN trace or a Vector log.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  dump(text);
  learn(text);
  return 0;
}
