#pragma once
// The master's part of the PDO matrix. As for the devices, the expected values were derived by
// hand.
#include <cstdint>
#include <vector>

namespace takt::test {

// clang-format off

/// Configuration of a pair of PDOs; times are in ms.
struct Pair {
  int inhibit = 0;     ///< inhibit time of the RPDO
  int repeat = 0;      ///< event timer of the RPDO
  int poll = 0;        ///< period of remote requests for the TPDO
  int poll_syncs = 0;  ///< period of remote requests in SYNCs
  int deadline = 0;    ///< deadline of the TPDO
  int timer = 0;       ///< event timer of the TPDO, in the device
  int silence = 0;     ///< inhibit time of the TPDO, in the device
  /// Cycles are counted from the cycle after an arrival, for TPDOs with their own phase.
  bool after_arrival = false;
  const char* model = "";  ///< model of the device
  const char* quirk = "";
};

/// A complete master and one device that returns in TPDO1 the data of RPDO1. Cycles take 10 ms and
/// are counted from the first command. The value is new in cycles 0, 3 and 4; cycle 6 repeats the
/// same command. The outputs of cycle k are sent at its end, 8 ms after SYNC k and before SYNC k +
/// 1.
struct LoopRow {
  const char* name;
  std::uint8_t rpdo;
  std::uint8_t tpdo;
  Pair pair;
  std::vector<int> rpdos;      ///< cycles out of 0..9 in which RPDO1 is sent
  std::vector<int> arrivals;   ///< cycles out of 1..10 whose image has a new TPDO1
  std::vector<int> missing{};  ///< cycles out of 1..10 whose image marks TPDO1 as missing
};

inline const std::vector<int> all_sent{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
inline const std::vector<int> all_there{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};

inline const std::vector<LoopRow> loop_rows{
    {"at once", 255, 255, {}, {0, 3, 4}, {1, 4, 5}},
    {"at once", 254, 254, {}, {0, 3, 4}, {1, 4, 5}},
    {"event, then SYNC", 255, 0, {}, {0, 3, 4}, {1, 4, 5}},
    // RPDO1 acts at SYNC k + 1, after the inputs were sampled; TPDO1 of type 0 follows at SYNC k +
    // 2.
    {"each waits for a SYNC", 0, 0, {}, {0, 3, 4}, {2, 5, 6}},
    {"sent when it acts", 0, 255, {}, {0, 3, 4}, {1, 4, 5}},
    {"each SYNC", 1, 1, {}, all_sent, all_there},
    {"event, and each SYNC", 0, 1, {}, {0, 3, 4}, all_there},
    {"each second SYNC", 255, 2, {.after_arrival = true}, {0, 3, 4}, {1, 3, 5, 7, 9}},
    {"each third SYNC", 255, 3, {.after_arrival = true}, {0, 3, 4}, {2, 5, 8}},
    {"each third SYNC", 0, 3, {.after_arrival = true}, {0, 3, 4}, {2, 5, 8}},
    {"each third SYNC", 1, 3, {.after_arrival = true}, all_sent, {2, 5, 8}},

    // Inhibit time 30 ms: RPDO1 is sent in cycle 0 and in cycle 3 (change); the change of cycle 4
    // is delayed to cycle 6.
    {"inhibit time: put off, not lost", 255, 255, {.inhibit = 30}, {0, 3, 6}, {1, 4, 7}},
    {"inhibit time: put off, not lost", 254, 255, {.inhibit = 30}, {0, 3, 6}, {1, 4, 7}},
    // The timer sends 20 ms after the last frame: cycle 2 by the timer, 3 and 4 by change, 6 and 8
    // by the timer.
    {"event timer", 255, 255, {.repeat = 20}, {0, 2, 3, 4, 6, 8}, {1, 4, 5}},
    {"event timer", 254, 255, {.repeat = 20}, {0, 2, 3, 4, 6, 8}, {1, 4, 5}},
    // Cycle 3 is by change and timer, 4 is delayed to 5, and 8 is by the timer.
    {"inhibit time and event timer", 255, 255, {.inhibit = 20, .repeat = 30}, {0, 3, 5, 8},
      {1, 4, 6}},
    {"an event timer shorter than the inhibit time", 255, 255, {.inhibit = 30, .repeat = 20},
      {0, 3, 6, 9}, {1, 4, 7}},
    {"neither is of type 0", 0, 255, {.inhibit = 30, .repeat = 20}, {0, 3, 4}, {1, 4, 5}},
    {"neither is of type 1", 1, 1, {.inhibit = 30, .repeat = 20}, all_sent, all_there},

    // The TPDO is requested in the slack of cycle k and arrives for image k + 1.
    {"polled each 10 ms", 255, 252, {.poll = 10}, {0, 3, 4}, all_there},
    {"polled each 10 ms", 255, 253, {.poll = 10}, {0, 3, 4}, all_there},
    {"polled each 10 ms, events besides", 255, 254, {.poll = 10}, {0, 3, 4}, all_there},
    {"polled each 10 ms, events besides", 255, 255, {.poll = 10}, {0, 3, 4}, all_there},
    {"polled each 30 ms", 255, 253, {.poll = 30, .after_arrival = true}, {0, 3, 4}, {2, 5, 8}},
    {"polled each 3rd SYNC", 255, 252, {.poll_syncs = 3, .after_arrival = true}, {0, 3, 4},
      {2, 5, 8}},
    {"polled each 3rd SYNC", 255, 253, {.poll_syncs = 3, .after_arrival = true}, {0, 3, 4},
      {2, 5, 8}},
    {"not polled", 255, 253, {}, {0, 3, 4}, {}},
    {"polled, but event, then SYNC", 255, 0, {.poll = 10}, {0, 3, 4}, {1, 4, 5}},
    {"polled, but each third SYNC", 255, 3, {.poll = 10, .after_arrival = true}, {0, 3, 4},
      {2, 5, 8}},
    // Answers to the other requests, and the changes, wait for the end of the device's inhibit time.
    {"polled within the inhibit time", 255, 254, {.poll = 10, .silence = 30, .after_arrival = true},
      {0, 3, 4}, {2, 5, 8}},
    {"polled within the inhibit time", 255, 255, {.poll = 10, .silence = 30, .after_arrival = true},
      {0, 3, 4}, {2, 5, 8}},
    {"polled, the inhibit time is of 254 and 255", 255, 252, {.poll = 10, .silence = 30}, {0, 3, 4},
      all_there},
    {"polled, the inhibit time is of 254 and 255", 255, 253, {.poll = 10, .silence = 30}, {0, 3, 4},
      all_there},

    // TPDO1 is sent at 8, 38 and 48 ms. It is missing 20 ms later, at 28 and 68 ms, and this is
    // reported once.
    {"deadline", 255, 255, {.deadline = 20}, {0, 3, 4}, {1, 4, 5}, {3, 7}},
    {"deadline", 255, 254, {.deadline = 20}, {0, 3, 4}, {1, 4, 5}, {3, 7}},
    {"deadline, kept by the device's timer", 255, 255, {.deadline = 50, .timer = 40,
      .after_arrival = true}, {0, 3, 4}, {1, 4, 5, 9}},

    // The device has an event timer of 40 ms that expired in the cycle before 0.
    {"301: begins anew with each frame", 255, 255, {.timer = 40, .after_arrival = true}, {0, 3, 4},
      {1, 4, 5, 9}},
    {"Lenze: cyclic in addition", 255, 254, {.timer = 40, .after_arrival = true,
      .model = "lenze8400"}, {0, 3, 4}, {1, 3, 4, 5, 7}},
    {"Lenze: 255 means the same", 255, 255, {.timer = 40, .after_arrival = true,
      .model = "lenze8400"}, {0, 3, 4}, {1, 3, 4, 5, 7}},
    {"Beckhoff: reset by the event", 255, 255, {.timer = 40, .after_arrival = true,
      .model = "beckhoff"}, {0, 3, 4}, {1, 4, 5, 9}},
    {"ars: reset by its expiry only", 255, 255, {.timer = 40, .after_arrival = true,
      .model = "plain301", .quirk = "event_timer_raster"}, {0, 3, 4}, {1, 3, 4, 5, 7}},
    {"DRV-28: periodic, changes send nothing", 255, 254, {.timer = 40, .after_arrival = true,
      .model = "astraada_drv28"}, {0, 3, 4}, {3, 7}},
    {"DRV-28: periodic, the RPDO sends nothing", 255, 255, {.timer = 40, .after_arrival = true,
      .model = "astraada_drv28"}, {0, 3, 4}, {3, 7}},

    // Other peculiarities of the families.
    {"DRV-28: each RPDO is answered, changed or not", 255, 255, {.repeat = 20,
      .model = "astraada_drv28"}, {0, 2, 3, 4, 6, 8}, {1, 3, 4, 5, 7, 9}},
    // The changes come at 8, 38 and 48 ms; the second and the third are sent together at 58 ms.
    {"DRV-28: once in the disabled time of 50 ms", 255, 254, {.model = "astraada_drv28"}, {0, 3, 4},
      {1, 6}},
    {"DRV-28: no answer to remote requests", 255, 254, {.poll = 10, .model = "astraada_drv28"},
      {0, 3, 4}, {1, 6}},
    {"DRV-28: each second SYNC", 255, 2, {.after_arrival = true, .model = "astraada_drv28"},
      {0, 3, 4}, {1, 3, 5, 7, 9}},
    {"DRV-28: each SYNC", 1, 1, {.model = "astraada_drv28"}, all_sent, all_there},
    {"Lenze: SYNC AND event", 255, 0, {.model = "lenze8400"}, {0, 3, 4}, {1, 4, 5}},
    {"Lenze: SYNC AND event, an elapsed cycle time is one", 255, 0, {.timer = 40,
      .after_arrival = true, .model = "lenze8400"}, {0, 3, 4}, {1, 3, 4, 5, 7}},
    {"Lenze: below 252 no answer", 255, 0, {.poll = 10, .model = "lenze8400"}, {0, 3, 4}, {1, 4, 5}},
    {"Lenze: below 252 no answer", 255, 3, {.poll = 10, .after_arrival = true,
      .model = "lenze8400"}, {0, 3, 4}, {2, 5, 8}},
    {"Lenze: every third sync", 255, 3, {.after_arrival = true, .model = "lenze8400"}, {0, 3, 4},
      {2, 5, 8}},
    {"Lenze: polled via RTR, synchronous", 255, 252, {.poll = 10, .model = "lenze8400"}, {0, 3, 4},
      all_there},
    {"Lenze: polled via RTR, asynchronous", 255, 253, {.poll = 10, .model = "lenze8400"}, {0, 3, 4},
      all_there},
    {"Lenze: every sync", 1, 1, {.model = "lenze8400"}, all_sent, all_there},
    {"Beckhoff: the sample has changed", 255, 0, {.model = "beckhoff"}, {0, 3, 4}, {1, 4, 5}},
    {"Beckhoff: the event timer is of 254 and 255", 255, 0, {.timer = 40, .model = "beckhoff"},
      {0, 3, 4}, {1, 4, 5}},
    {"Beckhoff: synchronous, only RTR", 255, 252, {.poll = 10, .model = "beckhoff"}, {0, 3, 4},
      all_there},
    {"Beckhoff: asynchronous, only RTR", 255, 253, {.poll = 10, .model = "beckhoff"}, {0, 3, 4},
      all_there},
    {"Beckhoff: evaluated after the next SYNC", 0, 0, {.model = "beckhoff"}, {0, 3, 4}, {2, 5, 6}},
    {"Beckhoff: set to valid when the next SYNC is received", 1, 255, {.model = "beckhoff"},
      all_sent, {1, 4, 5}},
    {"ars: every SYNC", 1, 1, {.model = "plain301", .quirk = "event_timer_raster"}, all_sent,
      all_there},
    {"ars: after the event", 255, 0, {.model = "plain301", .quirk = "event_timer_raster"}, {0, 3, 4},
      {1, 4, 5}},
    {"ars: updated by SYNC, on request", 255, 252, {.poll = 10, .model = "plain301",
      .quirk = "event_timer_raster"}, {0, 3, 4}, all_there},
    {"ars: on request", 255, 253, {.poll = 10, .model = "plain301", .quirk = "event_timer_raster"},
      {0, 3, 4}, all_there},
};

/// The cycles in which the master sends an RPDO. "ETI": the value is new in cycles 3 and 4 as well,
/// event timer of 20 ms, inhibit time of 30 ms. A letter means present, "-" absent, "." either.
struct RpdoCell {
  std::vector<std::uint8_t> types;
  const char* pattern;
  std::vector<int> rpdos;
};

inline const std::vector<RpdoCell> rpdo_cells{
    {{0}, "-..", {0}},
    {{0}, "E..", {0, 3, 4}},
    {{1}, "...", all_sent},
    {{254, 255}, "---", {0}},
    {{254, 255}, "E--", {0, 3, 4}},
    {{254, 255}, "-T-", {0, 2, 4, 6, 8}},
    {{254, 255}, "--I", {0}},
    {{254, 255}, "ET-", {0, 2, 3, 4, 6, 8}},
    {{254, 255}, "E-I", {0, 3, 6}},        // 4 is delayed
    {{254, 255}, "-TI", {0, 3, 6, 9}},     // the inhibit time is the longer one
    {{254, 255}, "ETI", {0, 3, 6, 9}},
};

/// A pair of PDOs of types n > 1. The types are the distances of their frames in SYNCs.
struct RasterRow {
  const char* name;
  const char* model;
  std::uint8_t rpdo;
  std::uint8_t tpdo;
};

inline const std::vector<RasterRow> raster_rows{
    {"301", "", 2, 3},
    {"Lenze: every n-th sync", "lenze8400", 3, 2},
    {"Beckhoff: digital inputs and analogue outputs", "beckhoff", 10, 1},
    {"Beckhoff: analogue inputs", "beckhoff", 2, 10},
    {"ars: every 34th SYNC", "plain301", 34, 34},
    {"DRV-28", "astraada_drv28", 5, 4},
};

/// SYNC start value of a TPDO; the master's SYNC carries a counter.
struct MasterStartRow {
  const char* name;
  std::uint8_t type;
  std::uint8_t start;
  std::uint8_t overflow;
  std::vector<int> counters;  ///< counters of the first SYNCs that a frame follows
};

inline const std::vector<MasterStartRow> master_start_rows{
    {"each third, from 2", 3, 2, 10, {2, 5, 8, 1, 4, 7, 10, 3, 6, 9, 2}},
    {"each fourth, from 3", 4, 3, 8, {3, 7, 3, 7}},
    {"each, from 5", 1, 5, 10, {5, 6, 7, 8, 9, 10, 1, 2}},
    {"each, from 9: not before", 1, 9, 10, {9, 10, 1, 2}},
    {"each seventh, from 7", 7, 7, 7, {7, 7, 7}},
};

// clang-format on

}  // namespace takt::test
