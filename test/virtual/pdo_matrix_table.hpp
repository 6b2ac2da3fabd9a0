#pragma once
// When PDOs are sent, worked out by hand from CiA 301 and from four manuals:
//   Lenze     8400 HighLine reference manual, DMS 12.0, p. 731
//   Beckhoff  FC5101 manual, p. 45
//   ars       ars-informatica, TPDO Communication Parameters
//   Astraada  DRV-28 communication card, p. 30
#include <cstdint>
#include <vector>

namespace takt::test {

// clang-format off

/// A TPDO of a device and what happens to it, in ms after NMT start; then the frames that must
/// come.
struct TpdoRow {
  const char* name;
  const char* model;  ///< of the simulated device; "": CiA 301
  const char* quirk;
  std::uint8_t type;
  std::uint16_t inhibit;     ///< sub 3 as it is written: 100 us, of the DRV-28 ms
  std::uint16_t timer;       ///< ms
  std::vector<int> changes;  ///< another value each time
  std::vector<int> back;     ///< the first value again
  std::vector<int> syncs;
  std::vector<int> remote;  ///< remote requests
  std::vector<int> rpdos;   ///< the RPDO of the same number comes
  std::vector<int> frames;  ///< sent within 200 ms
};

inline const std::vector<int> each_10{10, 20, 30, 40, 50};

inline const std::vector<TpdoRow> tpdo_rows{
    // type 0. 301: an event, then the next SYNC. The state on entering OPERATIONAL is an event.
    {"301, type 0: two events, one frame", "", "", 0, 0, 0, {12, 14, 33}, {}, each_10, {}, {}, {10,
      20, 40}},
    {"301, type 0: a pulse between two SYNCs is an event", "", "", 0, 0, 0, {12}, {15}, each_10, {},
      {}, {10, 20}},
    {"301, type 0: inhibit time and event timer mean nothing", "", "", 0, 500, 25, {12}, {},
      each_10, {}, {}, {10, 20}},
    {"301, type 0: no answer to remote requests", "", "", 0, 0, 0, {}, {}, each_10, {5, 15}, {},
      {10}},
    {"Lenze, type 0: SYNC and event", "lenze8400", "", 0, 0, 0, {12, 33}, {}, each_10, {}, {}, {10,
      20, 40}},
    {"Lenze, type 0: a cycle time that has elapsed is an event", "lenze8400", "", 0, 0, 24, {}, {},
      {10, 20, 30, 40, 50, 60, 70, 80}, {}, {}, {10, 30, 50, 80}},
    {"Beckhoff, type 0: sampled at SYNC, sent if the sample has changed", "beckhoff", "", 0, 0, 0,
      {12, 33}, {}, each_10, {}, {}, {10, 20, 40}},
    {"Beckhoff, type 0: a pulse between two SYNCs is not seen", "beckhoff", "", 0, 0, 0, {12}, {15},
      each_10, {}, {}, {10}},
    {"ars, type 0: after the event", "plain301", "event_timer_raster", 0, 0, 0, {12}, {}, each_10,
      {}, {}, {10, 20}},

    // types 1..240: after each n-th SYNC, changed or not
    {"301, type 1", "", "", 1, 0, 0, {12}, {}, each_10, {}, {}, {10, 20, 30, 40, 50}},
    {"301, type 1: inhibit time and event timer mean nothing", "", "", 1, 500, 25, {12}, {},
      each_10, {}, {}, {10, 20, 30, 40, 50}},
    {"301, type 2", "", "", 2, 0, 0, {}, {}, each_10, {}, {}, {20, 40}},
    {"301, type 5", "", "", 5, 0, 0, {}, {}, each_10, {}, {}, {50}},
    {"Lenze, type 1", "lenze8400", "", 1, 0, 0, {}, {}, each_10, {}, {}, {10, 20, 30, 40, 50}},
    {"Lenze, type 3", "lenze8400", "", 3, 0, 0, {}, {}, each_10, {}, {}, {30}},
    {"Beckhoff, digital inputs, type 1", "beckhoff", "", 1, 0, 0, {}, {}, each_10, {}, {}, {10, 20,
      30, 40, 50}},
    {"Beckhoff, analogue inputs, type 10", "beckhoff", "", 10, 0, 0, {}, {}, {10, 20, 30, 40, 50,
      60, 70, 80, 90, 100, 110, 120, 130, 140, 150, 160, 170, 180, 190, 200}, {}, {}, {100, 200}},
    {"ars, type 4", "plain301", "event_timer_raster", 4, 0, 0, {}, {}, each_10, {}, {}, {40}},
    {"DRV-28, type 2", "astraada_drv28", "", 2, 500, 0, {}, {}, each_10, {}, {}, {20, 40}},

    // 252: sampled at SYNC, sent on request; before the first SYNC there is nothing
    {"301, type 252", "", "", 252, 0, 0, {12}, {}, {10, 20}, {5, 15, 17, 25}, {}, {15, 17, 25}},
    {"301, type 252: no event, no timer", "", "", 252, 0, 20, {12, 33}, {}, each_10, {}, {}, {}},
    {"Lenze, type 252", "lenze8400", "", 252, 0, 0, {}, {}, {10}, {5, 15}, {}, {15}},
    // 253: sampled and sent on request
    {"301, type 253", "", "", 253, 0, 20, {12}, {}, each_10, {5, 15}, {}, {5, 15}},
    {"Lenze, type 253", "lenze8400", "", 253, 0, 0, {12}, {}, each_10, {5, 15}, {}, {5, 15}},
    {"ars, type 253", "plain301", "event_timer_raster", 253, 0, 0, {}, {}, {}, {7}, {}, {7}},

    // 254, 255 of CiA 301: by event, by timer, by request; SYNC means nothing
    {"301, type 254: each change", "", "", 254, 0, 0, {12, 14, 33}, {}, each_10, {}, {}, {0, 12, 14,
      33}},
    {"301, type 255: each change", "", "", 255, 0, 0, {12, 14, 33}, {}, each_10, {}, {}, {0, 12, 14,
      33}},
    {"301, type 255: remote requests are answered", "", "", 255, 0, 0, {}, {}, {}, {5, 9}, {}, {0,
      5, 9}},
    {"301, type 254: inhibit and timer, the timeline of 5.3", "", "", 254, 100, 50, {3, 7, 12, 80},
      {}, {}, {}, {}, {0, 10, 20, 70, 80, 130, 180}},
    {"301, type 255: inhibit and timer, the timeline of 5.3", "", "", 255, 100, 50, {3, 7, 12, 80},
      {}, {}, {}, {}, {0, 10, 20, 70, 80, 130, 180}},
    {"301, type 255: an event inside the inhibit time is put off, not lost", "", "", 255, 100, 0,
      {3}, {5}, {}, {}, {}, {0, 10}},
    {"301, type 255: the inhibit time ends and the next event goes at once", "", "", 255, 100, 0,
      {30, 31, 45}, {}, {}, {}, {}, {0, 30, 40, 50}},
    {"301, type 255: only the timer", "", "", 255, 0, 50, {}, {}, {}, {}, {}, {0, 50, 100, 150,
      200}},
    {"301, type 255: the timer begins anew with each frame", "", "", 255, 0, 50, {20}, {}, {}, {},
      {}, {0, 20, 70, 120, 170}},
    {"301, type 255: a timer shorter than the inhibit time", "", "", 255, 400, 15, {}, {}, {}, {},
      {}, {0, 40, 80, 120, 160, 200}},
    {"ars, type 255: the timer begins anew only when it has run out", "plain301",
      "event_timer_raster", 255, 0, 50, {20}, {}, {}, {}, {}, {0, 20, 50, 100, 150, 200}},
    {"plain 301, type 255: the timer begins anew with each frame", "plain301", "", 255, 0, 50, {20},
      {}, {}, {}, {}, {0, 20, 70, 120, 170}},
    {"Lenze, type 254: cyclic in addition to events", "lenze8400", "", 254, 0, 50, {20}, {}, {}, {},
      {}, {0, 20, 50, 100, 150, 200}},
    {"Lenze, type 255 means the same", "lenze8400", "", 255, 0, 50, {20}, {}, {}, {}, {}, {0, 20,
      50, 100, 150, 200}},
    {"Beckhoff, type 255: the timer is an extra event", "beckhoff", "", 255, 0, 50, {20}, {}, {},
      {}, {}, {0, 20, 70, 120, 170}},

    // 254, 255 of the DRV-28; its state is not told at the start
    {"DRV-28, type 254 with timer: periodic, changes send nothing", "astraada_drv28", "", 254, 500,
      60, {20, 70}, {}, {}, {}, {}, {60, 120, 180}},
    {"DRV-28, type 254 without: once in the disabled time, in ms", "astraada_drv28", "", 254, 100,
      0, {10, 20, 30}, {}, {}, {}, {}, {10, 110}},
    {"DRV-28, type 254: less than 50 ms is taken as 50", "astraada_drv28", "", 254, 20, 0, {10, 30},
      {}, {}, {}, {}, {10, 60}},
    {"DRV-28, type 255 with timer: periodic", "astraada_drv28", "", 255, 500, 60, {20}, {}, {}, {},
      {30}, {60, 120, 180}},
    {"DRV-28, type 255 without: each time the RPDO comes", "astraada_drv28", "", 255, 500, 0, {20},
      {}, {}, {}, {10, 35}, {10, 35}},

    // Seams between the rows above, worked out again from the manuals alone.
    {"301, type 255: an answer to a remote request is a transmission: the timer begins anew", "",
      "", 255, 0, 50, {}, {}, {}, {20}, {}, {0, 20, 70, 120, 170}},
    {"Lenze, type 0: a pulse between two SYNCs is an event", "lenze8400", "", 0, 0, 0, {12}, {15},
      each_10, {}, {}, {10, 20}},
    {"Lenze, type 254: a cycle that ends inside the inhibit time", "lenze8400", "", 254, 100, 50,
      {45}, {}, {}, {}, {}, {0, 45, 55, 100, 150, 200}},
    {"Lenze, type 255: polled besides", "lenze8400", "", 255, 0, 0, {7}, {}, each_10, {5, 9}, {},
      {0, 5, 7, 9}},
    {"Beckhoff, type 0: there and back over a SYNC", "beckhoff", "", 0, 0, 0, {12}, {25}, each_10,
      {}, {}, {10, 20, 30}},
    {"Beckhoff, type 0: two changes, one sample", "beckhoff", "", 0, 0, 0, {11, 13}, {}, each_10,
      {}, {}, {10, 20}},
    {"Beckhoff, type 252: nothing before the first SYNC", "beckhoff", "", 252, 0, 0, {}, {}, {10},
      {5, 15}, {}, {15}},
    {"Beckhoff, type 253", "beckhoff", "", 253, 0, 0, {3}, {}, each_10, {5}, {}, {5}},
    {"ars, type 34: each 34th SYNC", "plain301", "event_timer_raster", 34, 0, 0, {}, {}, {5, 10, 15,
      20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 75, 80, 85, 90, 95, 100, 105, 110, 115, 120, 125,
      130, 135, 140, 145, 150, 155, 160, 165, 170, 175, 180, 185, 190, 195, 200}, {}, {}, {170}},
    {"ars, type 252: SYNC updates, a request sends", "plain301", "event_timer_raster", 252, 0, 0,
      {}, {}, {10, 20}, {25}, {}, {25}},
    {"ars, type 255: a window of inhibit time and timer", "plain301", "event_timer_raster", 255,
      100, 50, {3, 7, 12, 80}, {}, {}, {}, {}, {0, 10, 20, 50, 80, 100, 150, 200}},
    {"ars, type 255: a timer shorter than the inhibit time", "plain301", "event_timer_raster", 255,
      400, 25, {}, {}, {}, {}, {}, {0, 40, 80, 120, 160, 200}},
    {"ars, type 255: put off by the inhibit time, the timer's own raster stays", "plain301",
      "event_timer_raster", 255, 100, 50, {45}, {}, {}, {}, {}, {0, 45, 55, 100, 150, 200}},
    {"DRV-28, type 1: the disabled time means nothing", "astraada_drv28", "", 1, 500, 0, {12}, {},
      each_10, {}, {}, {10, 20, 30, 40, 50}},
    {"DRV-28, type 254: there and back is two changes", "astraada_drv28", "", 254, 50, 0, {10},
      {15}, {}, {}, {}, {10, 60}},
    {"DRV-28, type 254: SYNC and RPDO send nothing", "astraada_drv28", "", 254, 50, 0, {}, {},
      each_10, {}, {15, 25}, {}},
    {"DRV-28, type 255: each RPDO is answered, the disabled time is of 254", "astraada_drv28", "",
      255, 500, 0, {}, {}, {}, {}, {10, 11, 12}, {10, 11, 12}},
    {"DRV-28, type 255 with timer: an RPDO sends nothing", "astraada_drv28", "", 255, 0, 80, {}, {},
      {}, {}, {10, 30}, {80, 160}},
};

/// SYNC start value: SYNC number k (at 10 k ms) carries the counter (k - 1) mod overflow + 1.
struct StartRow {
  const char* name;
  std::uint8_t type;
  std::uint8_t start;
  std::uint8_t overflow;
  std::vector<int> syncs;  ///< of the first 21, those that a frame follows
};

inline const std::vector<StartRow> start_rows{
    {"n 3, start 2 of 10: counters 2 5 8 1 4 7 10", 3, 2, 10, {2, 5, 8, 11, 14, 17, 20}},
    {"n 4, start 3 of 8: counters 3 7 3 7", 4, 3, 8, {3, 7, 11, 15, 19}},
    {"n 1, start 5 of 10", 1, 5, 10, {5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20,
      21}},
    {"no counter: the start value means nothing", 3, 2, 0, {3, 6, 9, 12, 15, 18, 21}},
    {"start 0: any", 3, 0, 10, {3, 6, 9, 12, 15, 18, 21}},
};

/// Whole master and one device that gives back in TPDO1 what RPDO1 brings. Cycles of 10 ms, counted
/// from the first command; the value is new in cycles 0, 3 and 4, in cycle 6 the same is commanded
/// again. Outputs of cycle k are sent at its end, before SYNC k + 1.
struct LoopRow {
  const char* name;
  std::uint8_t rpdo;
  std::uint8_t tpdo;
  int inhibit_ms;             ///< of the RPDO
  int repeat_ms;              ///< event timer of the RPDO
  int poll_ms;                ///< remote requests for the TPDO
  std::vector<int> rpdos;     ///< cycles in which RPDO1 goes out, of 0..9
  std::vector<int> arrivals;  ///< cycles in whose image TPDO1 has arrived, of 1..10
};

inline const std::vector<LoopRow> loop_rows{
    {"255 and 255: at once", 255, 255, 0, 0, 0, {0, 3, 4}, {1, 4, 5}},
    {"254 and 254: at once", 254, 254, 0, 0, 0, {0, 3, 4}, {1, 4, 5}},
    {"255 and 0: event, then SYNC", 255, 0, 0, 0, 0, {0, 3, 4}, {1, 4, 5}},
    // Acts at SYNC k + 1, after the inputs were sampled; TPDO1 of type 0 follows at SYNC k + 2.
    {"0 and 0: each waits for a SYNC", 0, 0, 0, 0, 0, {0, 3, 4}, {2, 5, 6}},
    {"0 and 255: sent when it acts", 0, 255, 0, 0, 0, {0, 3, 4}, {1, 4, 5}},
    {"1 and 1", 1, 1, 0, 0, 0, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}},
    {"0 and 1", 0, 1, 0, 0, 0, {0, 3, 4}, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}},
    // 30 ms: 0, the change of cycle 3, that of cycle 4 put off to cycle 6
    {"255 with inhibit time: put off, not lost", 255, 255, 30, 0, 0, {0, 3, 6}, {1, 4, 7}},
    // 20 ms after the last frame: 2 by the timer, 3 and 4 by change, 6 and 8 by the timer
    {"255 with event timer", 255, 255, 0, 20, 0, {0, 2, 3, 4, 6, 8}, {1, 4, 5}},
    // Asked for in the slack of cycle k, there in image k + 1.
    {"255 and 253, polled each 10 ms", 255, 253, 0, 0, 10, {0, 3, 4}, {1, 2, 3, 4, 5, 6, 7, 8, 9,
      10}},
    {"255 and 252, polled each 10 ms", 255, 252, 0, 0, 10, {0, 3, 4}, {1, 2, 3, 4, 5, 6, 7, 8, 9,
      10}},
};

// clang-format on

}  // namespace takt::test
