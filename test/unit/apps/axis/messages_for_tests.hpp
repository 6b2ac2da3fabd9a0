#pragma once
#include <cstdint>
#include <initializer_list>
#include <string>
#include <takt/image_t.hpp>
#include <takt/layout_t.hpp>
#include <takt/status_t.hpp>

namespace takt::test {

inline constexpr std::int64_t session = 77;
inline constexpr std::int64_t hash = 1234;

inline signal_t signal(std::int16_t node, std::int32_t index, bool output, std::int16_t bits,
                       double scale = 1.0) {
  signal_t made{};
  made.node = node == 5 ? "shoulder" : "elbow";
  made.node_id = node;
  made.index = index;
  made.output = output ? 1 : 0;
  made.bits = bits;
  made.data_type = bits == 8 ? 2 : bits == 16 ? 6 : 4;  // INTEGER8, UNSIGNED16, INTEGER32
  made.scale = scale;
  return made;
}

/// Makes a layout with statusword, position, controlword and target of nodes 5 and 6; 1000 counts
/// are one unit.
inline layout_t two_axes() {
  layout_t layout{};
  layout.schema = 2;
  layout.parts = 1;
  layout.session = session;
  layout.hash = hash;
  layout.period_ns = 2'000'000;
  layout.signals = {signal(5, 0x6041, false, 16),       signal(6, 0x6041, false, 16),
                    signal(5, 0x6064, false, 32, 1e-3), signal(6, 0x6064, false, 32, 1e-3),
                    signal(5, 0x6040, true, 16),        signal(6, 0x6040, true, 16),
                    signal(5, 0x607A, true, 32, 1e-3),  signal(6, 0x607A, true, 32, 1e-3)};
  layout.num_signals = layout.total_signals = 8;
  layout.inputs = 4;
  return layout;
}

/// Makes an image; `values` are the inputs, and the outputs stay zero.
inline image_t image(std::int64_t cycle, std::initializer_list<std::int64_t> values) {
  image_t made{};
  made.schema = 2;
  made.parts = 1;
  made.session = session;
  made.layout_hash = hash;
  made.cycle = cycle;
  made.values = values;
  made.values.resize(8);
  made.num_values = 8;
  return made;
}

/// Makes a status that shows who holds nodes 5 and 6.
inline status_t status(const std::string& holder_of_5, const std::string& holder_of_6) {
  status_t made{};
  made.schema = 2;
  made.parts = 1;
  made.session = session;
  made.nodes.resize(2);
  made.nodes[0].node_id = 5;
  made.nodes[0].holder = holder_of_5;
  made.nodes[1].node_id = 6;
  made.nodes[1].holder = holder_of_6;
  made.num_nodes = 2;
  return made;
}

}  // namespace takt::test
