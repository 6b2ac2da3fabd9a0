#pragma once
#include <gtest/gtest.h>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"
#include "master/explain/frame/frame_text.hpp"

namespace takt::test {

struct KnownNetwork {
  BusPlan plan;
  std::vector<DeviceTable> devices;
};

inline KnownNetwork network_with_shoulder() {
  KnownNetwork network;
  NodePlan node{.name = "shoulder",
                .id = 5_node,
                .description_file = {},
                .product_name = {},
                .boot_plan = {}};
  network.plan.nodes.push_back(std::move(node));
  const auto signal = [&](const char* name, std::uint16_t index, DataType type, std::uint8_t bits) {
    Signal out{.name = name,
               .node = 5_node,
               .object = {},
               .unit = {},
               .safe_value = {},
               .seeded_from = {}};
    out.object.index = index;
    out.type = type;
    out.bits = bits;
    network.plan.layout.signals.push_back(out);
  };
  signal("statusword", 0x6041, DataType::unsigned16, 16);
  signal("position_actual_value", 0x6064, DataType::integer32, 32);
  signal("modes_of_operation_display", 0x6061, DataType::integer8, 8);
  network.plan.layout.signals[1].scale = 0.001;
  network.plan.layout.signals[1].unit = "rad";
  network.plan.pdos.fields = {{.signal = 0, .bit_offset = 0, .bits = 16},
                              {.signal = 1, .bit_offset = 16, .bits = 32, .sign_extend = true},
                              {.signal = 2, .bit_offset = 48, .bits = 8, .sign_extend = true}};
  network.plan.pdos.tpdos.push_back({.cob_id = CobId::base(0x185),
                                     .node = 5_node,
                                     .number = 1,
                                     .length = 7,
                                     .first_field = 0,
                                     .field_count = 3});
  DeviceTable device{.node = 5_node, .name = "shoulder", .objects = {}, .model = {}, .quirks = {}};
  device.objects.push_back({.key = {0x6083, 0},
                            .type = DataType::unsigned32,
                            .value = {},
                            .low_limit = {},
                            .high_limit = {}});
  network.devices.push_back(std::move(device));
  return network;
}

class FrameTextFixture : public testing::Test {
 protected:
  std::string read(FrameText& reader, std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
    const FrameMeaning meaning = reader.meaning(make_frame(CobId::base(id), bytes));
    return std::string{meaning.service} + " " + meaning.text;
  }
  std::string plain(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
    return read(plain_, id, bytes);
  }
  std::string named(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
    return read(named_, id, bytes);
  }

  KnownNetwork network_ = network_with_shoulder();
  FrameText plain_;
  FrameText named_{network_.plan, network_.devices};
};

}  // namespace takt::test
