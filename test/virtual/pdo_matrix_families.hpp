#pragma once
// Rows from four manuals. Each row or group of rows quotes the words that it follows from.
//   Lenze     8400 HighLine reference manual, DMS 12.0, p. 731
//   Beckhoff  FC5101 manual, p. 45
//   ars       ars-informatica, TPDO Communication Parameters
//   Astraada  DRV-28 communication card, p. 30
#include "test/virtual/pdo_matrix_row.hpp"

namespace takt::test {

// clang-format off

inline const std::vector<TpdoRow> rows_lenze{
    // "Event-controlled with every sync"; an elapsed cycle time is an event.
    {0, "E: SYNC AND event", {.changes = {12, 33}}, {}},
    {0, "T: SYNC AND event", {.timer = 24}, {}},
    {0, "S: SYNC AND event", {.syncs = each_10}, {10}},
    {0, "E+S: SYNC AND event", {.changes = {12, 33}, .syncs = each_10}, {10, 20, 40}},
    {0, "E+S: a bit change there and back", {.changes = {12}, .back = {15}, .syncs = each_10},
      {10, 20}},
    {0, "T+S: the cycle time has elapsed",
      {.timer = 24, .syncs = {10, 20, 30, 40, 50, 60, 70, 80}}, {10, 30, 50, 80}},
    {0, "T+E+S: each event counts", {.timer = 24, .changes = {12}, .syncs = each_10},
      {10, 20, 30, 50}},
    {0, "I+E+S: an event, a SYNC, nothing else",
      {.inhibit = 500, .changes = {12, 22}, .syncs = each_10}, {10, 20, 30}},

    // "n = 1: with every sync", "with every n-th sync".
    {1, "E: sync-controlled", {.changes = {12}}, {}},
    {1, "T: sync-controlled", {.timer = 25}, {}},
    {1, "S: every sync", {.syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "E+S: no logic combination", {.changes = {12}, .syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "T+S: no logic combination", {.timer = 25, .syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "I+S: every sync", {.inhibit = 500, .syncs = each_10}, {10, 20, 30, 40, 50}},
    {3, "E: sync-controlled", {.changes = {12}}, {}},
    {3, "T: sync-controlled", {.timer = 25}, {}},
    {3, "S: every third sync", {.syncs = each_10}, {30}},
    {3, "E+S: no logic combination", {.changes = {12}, .syncs = each_10}, {30}},
    {3, "T+S: no logic combination", {.timer = 25, .syncs = each_10}, {30}},
    {3, "I+S: every third sync", {.inhibit = 500, .syncs = each_10}, {30}},

    // "Synchronous - RTR only", "Asynchronous - RTR only".
    {252, "E: RTR only", {.changes = {12}}, {}},
    {252, "T: RTR only", {.timer = 20}, {}},
    {252, "S: RTR only", {.syncs = each_10}, {}},
    {252, "R+S: synchronous", {.syncs = {10}, .remote = {5, 15}}, {15}},
    {252, "T+E+R+S: RTR only",
      {.timer = 20, .changes = {12}, .syncs = each_10, .remote = {15, 45}}, {15, 45}},
    {253, "E: RTR only", {.changes = {12}}, {}},
    {253, "T: RTR only", {.timer = 20}, {}},
    {253, "S: RTR only", {.syncs = each_10}, {}},
    {253, "R: asynchronous", {.remote = {5, 15}}, {5, 15}},
    {253, "E+R+S: RTR only", {.changes = {12}, .syncs = each_10, .remote = {5, 15}}, {5, 15}},

    // "Event-controlled or cyclic"; "cyclic transmission takes place in addition".
    {254, "E: event-controlled", {.changes = {12, 14, 33}}, {0, 12, 14, 33}},
    {254, "S: asynchronous", {.syncs = each_10}, {0}},
    {254, "T: cyclic", {.timer = 50}, {0, 50, 100, 150, 200}},
    {254, "T+E: cyclic in addition", {.timer = 50, .changes = {20}}, {0, 20, 50, 100, 150, 200}},
    {254, "T+R: cyclic in addition", {.timer = 50, .remote = {20}}, {0, 20, 50, 100, 150, 200}},
    {254, "I+E: put off, not lost", {.inhibit = 100, .changes = {3}, .back = {5}}, {0, 10}},
    {254, "I+T+E: a cycle that ends inside the inhibit time",
      {.inhibit = 100, .timer = 50, .changes = {45}}, {0, 45, 55, 100, 150, 200}},
    {254, "R: polled via RTR", {.remote = {5, 9}}, {0, 5, 9}},
    // "254 and 255 have the same meaning".
    {255, "E: as 254", {.changes = {12, 14, 33}}, {0, 12, 14, 33}},
    {255, "S: as 254", {.syncs = each_10}, {0}},
    {255, "T: as 254", {.timer = 50}, {0, 50, 100, 150, 200}},
    {255, "T+S: as 254", {.timer = 50, .syncs = each_10}, {0, 50, 100, 150, 200}},
    {255, "T+E: as 254", {.timer = 50, .changes = {20}}, {0, 20, 50, 100, 150, 200}},
    {255, "T+R: as 254", {.timer = 50, .remote = {20}}, {0, 20, 50, 100, 150, 200}},
    {255, "I+E: as 254", {.inhibit = 100, .changes = {3}, .back = {5}}, {0, 10}},
    {255, "I+T: a cycle shorter than the inhibit time", {.inhibit = 400, .timer = 25},
      {0, 40, 80, 120, 160, 200}},
    {255, "I+T+E: as 254", {.inhibit = 100, .timer = 50, .changes = {45}},
      {0, 45, 55, 100, 150, 200}},
    {255, "R: as 254", {.remote = {5, 9}}, {0, 5, 9}},
    {255, "E+R+S: polled besides", {.changes = {7}, .syncs = each_10, .remote = {5, 9}},
      {0, 5, 7, 9}},
};

inline const std::vector<TpdoRow> rows_beckhoff{
    // "Acquires its input data when it receives the SYNC and then transmits it if the data
    // correspond to an event": the event is a change of the sample.
    {0, "E: acquired at SYNC only", {.changes = {12, 33}}, {}},
    {0, "T: acquired at SYNC only", {.timer = 25}, {}},
    {0, "S: no event", {.syncs = each_10}, {10}},
    {0, "E+S: the sample has changed", {.changes = {12, 33}, .syncs = each_10}, {10, 20, 40}},
    {0, "E+S: a pulse between two SYNCs is not seen",
      {.changes = {12}, .back = {15}, .syncs = each_10}, {10}},
    {0, "E+S: there and back over a SYNC", {.changes = {12}, .back = {25}, .syncs = each_10},
      {10, 20, 30}},
    {0, "E+S: two changes, one sample", {.changes = {11, 13}, .syncs = each_10}, {10, 20}},
    {0, "I+E+S: SYNC gives the time", {.inhibit = 500, .changes = {12, 22}, .syncs = each_10},
      {10, 20, 30}},
    {0, "R+S: not 'only RTR'", {.syncs = each_10, .remote = {5, 15}}, {10}},

    // "After every nth SYNC": n = 1 for digital inputs, n = 10 for analogue ones.
    {1, "E: cyclical, synchronous", {.changes = {12}}, {}},
    {1, "T: cyclical, synchronous", {.timer = 25}, {}},
    {1, "S: digital inputs", {.syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "E+S: changed or not", {.changes = {12}, .syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "T+S: synchronous", {.timer = 25, .syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "I+S: synchronous", {.inhibit = 500, .syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "R+S: not 'only RTR'", {.syncs = each_10, .remote = {5, 15}}, {10, 20, 30, 40, 50}},
    {10, "E: cyclical, synchronous", {.changes = {12}}, {}},
    {10, "T: cyclical, synchronous", {.timer = 25}, {}},
    {10, "S: analogue inputs", {.syncs = each_10_on}, {100, 200}},
    {10, "E+S: changed or not", {.changes = {12, 133}, .syncs = each_10_on}, {100, 200}},
    {10, "T+S: synchronous", {.timer = 25, .syncs = each_10_on}, {100, 200}},
    {10, "I+S: synchronous", {.inhibit = 1500, .syncs = each_10_on}, {100, 200}},
    {10, "R+S: not 'only RTR'", {.syncs = each_10_on, .remote = {5, 105}}, {100, 200}},

    // "Synchronous, only RTR", "asynchronous, only RTR".
    {252, "E: only RTR", {.changes = {12}}, {}},
    {252, "T: only RTR", {.timer = 20}, {}},
    {252, "S: only RTR", {.syncs = each_10}, {}},
    {252, "R+S: nothing before the first SYNC", {.syncs = {10}, .remote = {5, 15}}, {15}},
    {252, "T+E+S: only RTR", {.timer = 20, .changes = {12}, .syncs = each_10}, {}},
    {253, "E: only RTR", {.changes = {12}}, {}},
    {253, "T: only RTR", {.timer = 20}, {}},
    {253, "S: only RTR", {.syncs = each_10}, {}},
    {253, "R: asynchronous", {.remote = {5, 15}}, {5, 15}},
    {253, "E+R+S: only RTR", {.changes = {3}, .syncs = each_10, .remote = {5}}, {5}},

    // "Asynchronous"; an event timer adds an event, and application events reset the timer.
    {254, "E: each change", {.changes = {12, 14, 33}}, {0, 12, 14, 33}},
    {254, "S: asynchronous", {.syncs = each_10}, {0}},
    {254, "T: an event of its own", {.timer = 50}, {0, 50, 100, 150, 200}},
    {254, "T+E: reset by the event", {.timer = 50, .changes = {20}}, {0, 20, 70, 120, 170}},
    {254, "I+E: put off, not lost", {.inhibit = 100, .changes = {3}, .back = {5}}, {0, 10}},
    {254, "I+T+E: a window", {.inhibit = 100, .timer = 50, .changes = {3, 7, 12, 80}},
      {0, 10, 20, 70, 80, 130, 180}},
    {254, "R: nothing else is said than CiA 301", {.remote = {5, 9}}, {0, 5, 9}},
    {254, "R: not with bit 30", {.remote = {5, 9}, .no_rtr = true}, {0}},
    {255, "E: each change", {.changes = {12, 14, 33}}, {0, 12, 14, 33}},
    {255, "S: asynchronous", {.syncs = each_10}, {0}},
    {255, "T: an event of its own", {.timer = 50}, {0, 50, 100, 150, 200}},
    {255, "T+E: reset by the event", {.timer = 50, .changes = {20}}, {0, 20, 70, 120, 170}},
    {255, "I+E: put off, not lost", {.inhibit = 100, .changes = {3}, .back = {5}}, {0, 10}},
    {255, "I+T+E: a window", {.inhibit = 100, .timer = 50, .changes = {3, 7, 12, 80}},
      {0, 10, 20, 70, 80, 130, 180}},
    {255, "R: nothing else is said than CiA 301", {.remote = {5, 9}}, {0, 5, 9}},
    {255, "R: not with bit 30", {.remote = {5, 9}, .no_rtr = true}, {0}},
};

inline const std::vector<TpdoRow> rows_ars{
    // "Synchronous; which SYNC is given in the device profile": here the SYNC after the event.
    {0, "E: synchronous", {.changes = {12, 33}}, {}},
    {0, "T: synchronous", {.timer = 25}, {}},
    {0, "S: no event", {.syncs = each_10}, {10}},
    {0, "E+S: after the event", {.changes = {12}, .syncs = each_10}, {10, 20}},
    {0, "T+S: not event time driven", {.timer = 25, .syncs = each_10}, {10}},
    {0, "I+E+S: the SYNC triggers it", {.inhibit = 500, .changes = {12, 22}, .syncs = each_10},
      {10, 20, 30}},
    {0, "R+S: remote requests are of 252 and 253", {.syncs = each_10, .remote = {5, 15}}, {10}},

    // "Transmitted after every nth SYNC".
    {1, "E: synchronous", {.changes = {12}}, {}},
    {1, "T: synchronous", {.timer = 25}, {}},
    {1, "S: every SYNC", {.syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "E+S: every SYNC", {.changes = {12}, .syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "T+S: not event time driven", {.timer = 25, .syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "I+S: every SYNC", {.inhibit = 500, .syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "R+S: remote requests are of 252 and 253", {.syncs = each_10, .remote = {5, 15}},
      {10, 20, 30, 40, 50}},
    {4, "E: synchronous", {.changes = {12}}, {}},
    {4, "T: synchronous", {.timer = 25}, {}},
    {4, "S: every 4th SYNC", {.syncs = each_10}, {40}},
    {4, "E+S: every 4th SYNC", {.changes = {12}, .syncs = each_10}, {40}},
    {4, "T+S: not event time driven", {.timer = 25, .syncs = each_10}, {40}},
    {4, "I+S: every 4th SYNC", {.inhibit = 500, .syncs = each_10}, {40}},
    {4, "R+S: remote requests are of 252 and 253", {.syncs = each_10, .remote = {5, 15}}, {40}},
    {34, "S: every 34th SYNC", {.syncs = {5, 10, 15, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 75,
      80, 85, 90, 95, 100, 105, 110, 115, 120, 125, 130, 135, 140, 145, 150, 155, 160, 165, 170,
      175, 180, 185, 190, 195, 200}}, {170}},

    // "Updated on reception of a SYNC, only transmitted on reception of a Remote Transmission
    // Request"; for 253 the request both updates and transmits the data.
    {252, "E: only on request", {.changes = {12}}, {}},
    {252, "T: only on request", {.timer = 20}, {}},
    {252, "S: only on request", {.syncs = each_10}, {}},
    {252, "R+S: each request", {.syncs = {10, 20}, .remote = {25, 27}}, {25, 27}},
    {252, "T+E+R+S: only on request",
      {.timer = 20, .changes = {12}, .syncs = each_10, .remote = {15}}, {15}},
    {253, "E: on request", {.changes = {12}}, {}},
    {253, "T: on request", {.timer = 20}, {}},
    {253, "S: on request", {.syncs = each_10}, {}},
    {253, "R: on request", {.remote = {7}}, {7}},
    {253, "E+R: on request", {.changes = {3}, .remote = {7}}, {7}},

    // "If it is set to 100 the TPDO is transmitted every 100 ms"; "each time it is transmitted as a
    // result of the event timer expiring, the event timer is reset".
    {254, "E: each change", {.changes = {12, 14, 33}}, {0, 12, 14, 33}},
    {254, "S: asynchronous", {.syncs = each_10}, {0}},
    {254, "T: every event time", {.timer = 50}, {0, 50, 100, 150, 200}},
    {254, "T+E: reset by its expiry only", {.timer = 50, .changes = {20}},
      {0, 20, 50, 100, 150, 200}},
    {254, "I+E: not during the inhibit time", {.inhibit = 100, .changes = {3}, .back = {5}},
      {0, 10}},
    {254, "I+T+E: a time window", {.inhibit = 100, .timer = 50, .changes = {3, 7, 12, 80}},
      {0, 10, 20, 50, 80, 100, 150, 200}},
    {254, "R: polled individually", {.remote = {5, 9}}, {0, 5, 9}},
    {254, "R: not with bit 30", {.remote = {5, 9}, .no_rtr = true}, {0}},
    {255, "E: each change", {.changes = {12, 14, 33}}, {0, 12, 14, 33}},
    {255, "S: asynchronous", {.syncs = each_10}, {0}},
    {255, "T: every event time", {.timer = 100}, {0, 100, 200}},
    {255, "T+E: reset by its expiry only", {.timer = 50, .changes = {20}},
      {0, 20, 50, 100, 150, 200}},
    {255, "T+R: reset by its expiry only", {.timer = 50, .remote = {20}},
      {0, 20, 50, 100, 150, 200}},
    {255, "I+E: multiples of 100 microseconds", {.inhibit = 30, .changes = {1}}, {0, 3}},
    {255, "I+E: not during the inhibit time", {.inhibit = 100, .changes = {3}, .back = {5}},
      {0, 10}},
    {255, "I+T: not more often than the inhibit time", {.inhibit = 400, .timer = 25},
      {0, 40, 80, 120, 160, 200}},
    {255, "I+T+E: a time window", {.inhibit = 100, .timer = 50, .changes = {3, 7, 12, 80}},
      {0, 10, 20, 50, 80, 100, 150, 200}},
    {255, "I+T+E: put off by the inhibit time, the timer's own raster stays",
      {.inhibit = 100, .timer = 50, .changes = {45}}, {0, 45, 55, 100, 150, 200}},
    {255, "R: polled individually", {.remote = {5, 9}}, {0, 5, 9}},
    {255, "R: not with bit 30", {.remote = {5, 9}, .no_rtr = true}, {0}},
};

/// Table 3-11 of the manual has no types 0, 252 and 253, so the device refuses them. The device
/// does not send its state at the start, and the manual does not mention remote requests.
inline const std::vector<TpdoRow> rows_drv28{
    {1, "E: synchronous", {.changes = {12}}, {}},
    {1, "T: the event timer is of 254 and 255", {.timer = 60}, {}},
    {1, "P: an RPDO triggers 255", {.rpdos = {12}}, {}},
    {1, "T+S: the event timer is of 254 and 255", {.timer = 25, .syncs = each_10},
      {10, 20, 30, 40, 50}},
    {1, "I+E+S: the disabled time is of 254", {.inhibit = 500, .changes = {12}, .syncs = each_10},
      {10, 20, 30, 40, 50}},
    {1, "R+S: no remote requests", {.syncs = each_10, .remote = {5, 15}}, {10, 20, 30, 40, 50}},
    {2, "E: synchronous", {.changes = {12}}, {}},
    {2, "T: the event timer is of 254 and 255", {.timer = 60}, {}},
    {2, "I+S: the disabled time is of 254", {.inhibit = 500, .syncs = each_10}, {20, 40}},
    {2, "T+E+S: synchronous", {.timer = 25, .changes = {12}, .syncs = each_10}, {20, 40}},
    {2, "R+S: no remote requests", {.syncs = each_10, .remote = {5, 15}}, {20, 40}},

    // "Not zero: periodically"; "zero: once the data changes, only once in the disabled time", "a
    // period shorter than 50 ms: 50 ms is used".
    {254, "E: a disabled time of 0 is taken as 50", {.changes = {10, 30}}, {10, 60}},
    {254, "S+P: nothing has changed", {.inhibit = 50, .syncs = each_10, .rpdos = {15, 25}}, {}},
    {254, "T: at the interval of 60 ms", {.timer = 60}, {60, 120, 180}},
    {254, "T: 'set to 200: at the interval of 200 ms'", {.timer = 200}, {200}},
    {254, "T+S: at the interval", {.timer = 60, .syncs = each_10}, {60, 120, 180}},
    {254, "T+R: at the interval", {.timer = 60, .remote = {5, 15}}, {60, 120, 180}},
    {254, "I+T+E: periodic, changes send nothing",
      {.inhibit = 500, .timer = 60, .changes = {20, 70}}, {60, 120, 180}},
    {254, "I+E: once in the disabled time, in ms", {.inhibit = 100, .changes = {10, 20, 30}},
      {10, 110}},
    {254, "I+E: less than 50 ms is taken as 50", {.inhibit = 20, .changes = {10, 30}}, {10, 60}},
    {254, "I+E: there and back is two changes", {.inhibit = 50, .changes = {10}, .back = {15}},
      {10, 60}},
    {254, "I+E: 500 ms as it is delivered", {.inhibit = 500, .changes = {10, 30}}, {10}},
    {254, "I+E: over, so at once", {.inhibit = 100, .changes = {10, 150}}, {10, 150}},
    {254, "R: no remote requests", {.remote = {5, 15}}, {}},

    // "Not zero: periodically"; "zero: once a corresponding PDO Rx command is received".
    {255, "E: no PDO Rx", {.changes = {20}}, {}},
    {255, "S: no PDO Rx", {.syncs = each_10}, {}},
    {255, "R: no PDO Rx", {.remote = {5, 15}}, {}},
    {255, "T: at the interval of 60 ms", {.timer = 60}, {60, 120, 180}},
    {255, "T+S: at the interval", {.timer = 60, .syncs = each_10}, {60, 120, 180}},
    {255, "T+R: at the interval", {.timer = 60, .remote = {5, 15}}, {60, 120, 180}},
    {255, "T+P: at the interval, an RPDO sends nothing", {.timer = 80, .rpdos = {10, 30}},
      {80, 160}},
    {255, "I+T+E+P: periodic",
      {.inhibit = 500, .timer = 60, .changes = {20}, .rpdos = {30}}, {60, 120, 180}},
    {255, "I+P: each RPDO, the disabled time is of 254", {.inhibit = 500, .rpdos = {10, 11, 12}},
      {10, 11, 12}},
    {255, "I+E+P: each time the RPDO comes",
      {.inhibit = 500, .changes = {20}, .rpdos = {10, 35}}, {10, 35}},
    {255, "R+P: to the RPDO, not to the request", {.remote = {15}, .rpdos = {10}}, {10}},
};

// clang-format on

}  // namespace takt::test
