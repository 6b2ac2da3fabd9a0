// Repeats each cell of the PDO matrix with SYNC: a complete master produces the SYNC and receives
// the PDOs.
#include <algorithm>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "test/virtual/pdo_matrix_cells.hpp"
#include "test/virtual/pdo_matrix_combination.hpp"
#include "test/virtual/pdo_matrix_device.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr ObjectKey value_key{0x607A, 0};

BusPlan plan_of(std::uint8_t type) {
  BusPlan plan = test::axes(
      {.nodes = 1, .tpdo_type = type, .rpdo_type = 255, .period = 10ms, .fallback_cycles = 0});
  plan.layout.signals[3].seeded_from.reset();
  return plan;
}

/// A device like the loopback device but with the second pair of PDOs, because the first pair of a
/// DRV-28 is its parameter channel. Until the course begins, the TPDO has type 253 and is silent.
DeviceTable echo_device(const test::Reading& reading, const test::TpdoRow& row) {
  sim::SampleDevice device = sim::communicating(1_node);
  device.model(reading.model);
  if (*reading.quirk != 0) device.quirk(reading.quirk);
  device.object(0x6040, 0, DataType::unsigned16, Access::rww, 0, true)
      .object(0x607A, 0, DataType::integer32, Access::rww, 0, true)
      .pdo(0x1401, 0x201, 255, {0x6040'0010, 0x607A'0020})
      .pdo(0x1801, 0x181, 253, {0x6040'0010, 0x607A'0020});
  DeviceTable table = device.build();
  test::preset(table, {0x1801, 3}, row.course.inhibit);
  test::preset(table, {0x1801, 5}, row.course.timer);
  return table;
}

/// The data of a TPDO in the images of six cycles; SYNC k comes at 10 k ms.
struct Received {
  std::vector<std::uint32_t> frames;  ///< number of frames since the start of the course
  std::vector<int> missing;
};

class Course {
 public:
  Course(const test::Reading& reading, const test::TpdoRow& row)
      : rig_{plan_of(row.type), {.devices = {echo_device(reading, row)}}},
        guest_{rig_.world->attach()} {}

  bool boot() {
    const bool booted = rig_.boot();
    rig_.run(3);
    return booted;
  }
  Received run(const test::TpdoRow& row) {
    begin_ = rig_.recorder.with(0x080).back().start + 10ms;
    queue(row);
    Received received;
    rig_.on_image = [&](const ImageView& image) {
      received.frames.push_back(image.pdos[0].received);
      received.missing.push_back(image.pdos[0].is(PdoMark::missing) ? 1 : 0);
    };
    rig_.run(6);
    return received;
  }

 private:
  /// Sends a frame shortly after the moment, so that a SYNC at the same moment comes first.
  void at(int ms, const Frame& frame) {
    guest_.send(std::span{&frame, 1}, begin_ + 1ms * ms + 200us);
  }
  static Frame download(ObjectKey key, std::uint8_t value, unsigned bytes) {
    Frame frame = test::download(key, value, bytes);
    frame.id = CobId::base(0x601);
    return frame;
  }
  void queue(const test::TpdoRow& row) {
    at(0, download({0x1801, 2}, row.type, 1));
    std::uint8_t value = 0;
    for (const auto& [ms, moment] : test::moments_of(row.course)) {
      if (moment.change) at(ms, download(value_key, ++value, 4));
      if (moment.back) at(ms, download(value_key, 0, 4));
      if (moment.remote) at(ms, {.id = CobId::base(0x181), .length = 6, .rtr = true});
      if (moment.rpdo) at(ms, make_frame(CobId::base(0x201), {0, 0, 0, 0, 0, 0}));
    }
  }

  test::Rig rig_;
  sim::RemotePort& guest_;
  Time begin_{};
};

/// Returns the expected frame counts. Image k has the frames of the course up to half of its
/// window, 3 ms after SYNC k. The master does not wait for frames that do not follow SYNC.
std::vector<std::uint32_t> expected_of(const std::vector<int>& frames) {
  std::vector<std::uint32_t> counts;
  for (int k = 0; k < 6; ++k) {
    counts.push_back(static_cast<std::uint32_t>(
        std::ranges::count_if(frames, [&](int ms) { return ms < 10 * k + 3; })));
  }
  return counts;
}

void judge(const test::Reading& reading, const test::TpdoRow& row, const std::string& name) {
  Course course{reading, row};
  ASSERT_TRUE(course.boot()) << name;
  const Received received = course.run(row);
  EXPECT_EQ(received.frames, expected_of(row.frames)) << name;
  if (row.type < 1 || row.type > 2) {
    EXPECT_EQ(std::ranges::count(received.missing, 1), 0) << name;
    return;
  }
  // No TPDO of type 1 or 2 is missing after the first one has come.
  EXPECT_EQ(std::count(received.missing.begin() + row.type, received.missing.end(), 1), 0) << name;
}

TEST(PdoMatrix, MasterReceivesAsEachCellSays) {
  int cells = 0;
  for (const test::CellBlock& block : test::cell_blocks) {
    const test::Reading& reading = test::reading_of(block);
    for (const int type : block.types) {
      for (const std::string& name : test::combinations()) {
        if (name.find('S') == std::string::npos) continue;
        const test::Cell& cell = test::cell_of(block, name);
        judge(reading, test::row_of(type, name, cell),
              std::string{block.reading} + ", type " + std::to_string(type) + ", " + name);
        ++cells;
      }
    }
  }
  EXPECT_EQ(cells, 32 * 32);
}

}  // namespace
}  // namespace takt
