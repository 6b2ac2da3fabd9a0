#pragma once
// CiA 301, 7.2.2 and 7.5.2.37.
#include "test/virtual/pdo_matrix_row.hpp"

namespace takt::test {

// clang-format off

inline const std::vector<TpdoRow> rows_301{
    // The PDO is sent at the next SYNC after an event. The state on entering OPERATIONAL is an
    // event.
    {0, "E: without SYNC nothing", {.changes = {12, 33}}, {}},
    {0, "T: without SYNC nothing", {.timer = 25}, {}},
    {0, "S: without an event nothing more", {.syncs = each_10}, {10}},
    {0, "E+S: two events, one frame", {.changes = {12, 14, 33}, .syncs = each_10}, {10, 20, 40}},
    {0, "E+S: a pulse between two SYNCs is an event",
      {.changes = {12}, .back = {15}, .syncs = each_10}, {10, 20}},
    {0, "T+S: the event timer is of 254 and 255", {.timer = 25, .syncs = each_10}, {10}},
    {0, "I+E+S: so is the inhibit time",
      {.inhibit = 500, .changes = {12, 22}, .syncs = each_10}, {10, 20, 30}},
    {0, "I+T+E+S: neither means anything",
      {.inhibit = 500, .timer = 25, .changes = {12}, .syncs = each_10}, {10, 20}},
    {0, "R+S: no answer", {.syncs = each_10, .remote = {5, 15}}, {10}},

    // The PDO is sent after each n-th SYNC, changed or not.
    {1, "E: without SYNC nothing", {.changes = {12}}, {}},
    {1, "T: without SYNC nothing", {.timer = 25}, {}},
    {1, "R: without SYNC nothing", {.remote = {5, 15}}, {}},
    {1, "S: changed or not", {.syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "E+S: changed or not", {.changes = {12}, .syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "T+S: no event timer", {.timer = 25, .syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "I+S: no inhibit time", {.inhibit = 500, .syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "I+T+E+S: neither means anything",
      {.inhibit = 500, .timer = 25, .changes = {12}, .syncs = each_10}, {10, 20, 30, 40, 50}},
    {1, "R+S: no answer", {.syncs = each_10, .remote = {5, 15}}, {10, 20, 30, 40, 50}},
    {2, "E: without SYNC nothing", {.changes = {12}}, {}},
    {2, "T: without SYNC nothing", {.timer = 25}, {}},
    {2, "S: the second, the fourth", {.syncs = each_10}, {20, 40}},
    {2, "E+S: an event does not count", {.changes = {12, 25}, .syncs = each_10}, {20, 40}},
    {2, "T+S: no event timer", {.timer = 25, .syncs = each_10}, {20, 40}},
    {2, "I+S: no inhibit time", {.inhibit = 500, .syncs = each_10}, {20, 40}},
    {2, "R+S: no answer", {.syncs = each_10, .remote = {5, 15, 25}}, {20, 40}},
    {5, "S: the fifth", {.syncs = each_10}, {50}},
    {5, "R+S: no answer", {.syncs = each_10, .remote = {5, 15, 45}}, {50}},

    // The PDO is sampled at SYNC and sent on request. Before the first SYNC there is no valid
    // sample.
    {252, "E: on request only", {.changes = {12}}, {}},
    {252, "T: on request only", {.timer = 20}, {}},
    {252, "S: on request only", {.syncs = each_10}, {}},
    {252, "R: nothing was sampled", {.remote = {5, 15}}, {}},
    {252, "E+T+S: no event, no timer", {.timer = 20, .changes = {12, 33}, .syncs = each_10}, {}},
    {252, "E+R+S: from the first SYNC on",
      {.changes = {12}, .syncs = {10, 20}, .remote = {5, 15, 17, 25}}, {15, 17, 25}},
    {252, "I+R+S: no inhibit time",
      {.inhibit = 500, .syncs = {10}, .remote = {15, 17}}, {15, 17}},

    // The PDO is sampled and sent on request.
    {253, "E: on request only", {.changes = {12}}, {}},
    {253, "T: on request only", {.timer = 20}, {}},
    {253, "S: on request only", {.syncs = each_10}, {}},
    {253, "R: without SYNC", {.remote = {5, 15}}, {5, 15}},
    {253, "I+R: no inhibit time", {.inhibit = 100, .remote = {5, 7}}, {5, 7}},
    {253, "T+E+R+S: on request only",
      {.timer = 20, .changes = {12}, .syncs = each_10, .remote = {5, 15}}, {5, 15}},

    // The PDO is sent by event, by timer, and by request if bit 30 allows it. SYNC has no effect.
    // The state is sent at the start.
    {254, "E: each change", {.changes = {12, 14, 33}}, {0, 12, 14, 33}},
    {254, "S: means nothing", {.syncs = each_10}, {0}},
    {254, "E+S: SYNC means nothing", {.changes = {12, 14, 33}, .syncs = each_10}, {0, 12, 14, 33}},
    {254, "T: the longest silence", {.timer = 50}, {0, 50, 100, 150, 200}},
    {254, "T+E: begins anew with each frame", {.timer = 50, .changes = {20}},
      {0, 20, 70, 120, 170}},
    {254, "T+R: with an answer as well", {.timer = 50, .remote = {20}}, {0, 20, 70, 120, 170}},
    {254, "I+E: put off, not lost", {.inhibit = 100, .changes = {3}, .back = {5}}, {0, 10}},
    {254, "I+E: over, so at once", {.inhibit = 100, .changes = {30, 31, 45}}, {0, 30, 40, 50}},
    {254, "I+T: a timer shorter than the inhibit time", {.inhibit = 400, .timer = 15},
      {0, 40, 80, 120, 160, 200}},
    {254, "I+T+E: the timeline of 5.3",
      {.inhibit = 100, .timer = 50, .changes = {3, 7, 12, 80}}, {0, 10, 20, 70, 80, 130, 180}},
    {254, "R: answered", {.remote = {5, 9}}, {0, 5, 9}},
    {254, "R: not with bit 30", {.remote = {5, 9}, .no_rtr = true}, {0}},
    {254, "I+E+R: an answer is a transmission: the inhibit time begins anew",
      {.inhibit = 100, .changes = {22}, .remote = {20}}, {0, 20, 30}},

    {255, "E: each change", {.changes = {12, 14, 33}}, {0, 12, 14, 33}},
    {255, "S: means nothing", {.syncs = each_10}, {0}},
    {255, "E+S: SYNC means nothing", {.changes = {12, 14, 33}, .syncs = each_10}, {0, 12, 14, 33}},
    {255, "T: the longest silence", {.timer = 50}, {0, 50, 100, 150, 200}},
    {255, "T+S: SYNC means nothing", {.timer = 50, .syncs = each_10}, {0, 50, 100, 150, 200}},
    {255, "T+E: begins anew with each frame", {.timer = 50, .changes = {20}},
      {0, 20, 70, 120, 170}},
    {255, "T+R: with an answer as well", {.timer = 50, .remote = {20}}, {0, 20, 70, 120, 170}},
    {255, "I: sends nothing by itself", {.inhibit = 100}, {0}},
    {255, "I+E: put off, not lost", {.inhibit = 100, .changes = {3}, .back = {5}}, {0, 10}},
    {255, "I+E: over, so at once", {.inhibit = 100, .changes = {30, 31, 45}}, {0, 30, 40, 50}},
    {255, "I+T: a timer shorter than the inhibit time", {.inhibit = 400, .timer = 15},
      {0, 40, 80, 120, 160, 200}},
    {255, "I+T+E: the timeline of 5.3",
      {.inhibit = 100, .timer = 50, .changes = {3, 7, 12, 80}}, {0, 10, 20, 70, 80, 130, 180}},
    {255, "R: answered", {.remote = {5, 9}}, {0, 5, 9}},
    {255, "R: not with bit 30", {.remote = {5, 9}, .no_rtr = true}, {0}},
    {255, "E+R: events and requests", {.changes = {7}, .remote = {9}}, {0, 7, 9}},
    {255, "I+E+R: an answer is a transmission: the inhibit time begins anew",
      {.inhibit = 100, .changes = {22}, .remote = {20}}, {0, 20, 30}},
    {255, "P: an RPDO is no request", {.rpdos = {5}}, {0}},
};

// clang-format on

}  // namespace takt::test
