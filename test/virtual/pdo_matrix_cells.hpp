#pragma once
// Every cell of device x type x event, timer, inhibit time, RTR, SYNC, RPDO, for one course of
// events. If a manual is silent, the reason names "CiA 301" or the source of the interpretation.
#include <vector>

namespace takt::test {

// clang-format off

/// One combination of events and the expected frames of the first 103 ms. E: the value changes at
/// 12 ms, changes back at 14, and changes again at 33. T: event timer of 24 ms. I: inhibit time,
/// sub-index 3 is 90. R: remote requests at 5, 15, 17 and 37. S: SYNC at 10, 20, 30, 40 and 50. P:
/// the RPDO with the same number comes at 11 and 26.
struct Cell {
  const char* pattern;  ///< "ETIRSP": a letter means present, "-" absent, "." either
  std::vector<int> frames;
  const char* why;
};

/// The cells of a device for some types. Their patterns together match each of the 64 combinations
/// once.
struct CellBlock {
  const char* reading;  ///< name of an entry of `readings`
  std::vector<int> types;
  std::vector<Cell> cells;
};

inline const std::vector<CellBlock> cell_blocks{
    {"301", {0}, {
      {"....-.", {}, "an event, then the next SYNC"},
      {"-...S.", {10}, "the state is told with the first SYNC"},
      {"E...S.", {10, 20, 40}, "12 and 14 are events of one SYNC; T, I are of 254, 255, R of 252.."},
    }},
    {"301", {1}, {
      {"....-.", {}, "after SYNC only"},
      {"....S.", {10, 20, 30, 40, 50}, "after each SYNC"},
    }},
    {"301", {2}, {
      {"....-.", {}, "after SYNC only"},
      {"....S.", {20, 40}, "after each second SYNC"},
    }},
    {"301", {252}, {
      {"...-..", {}, "on request only"},
      {"...R-.", {}, "nothing was ever sampled"},
      {"...RS.", {15, 17, 37}, "at 5 nothing was sampled yet; the inhibit time is of 254, 255"},
    }},
    {"301", {253}, {
      {"...-..", {}, "on request only"},
      {"...R..", {5, 15, 17, 37}, "at once; the inhibit time is of 254, 255"},
    }},
    // Each frame restarts the timer. The inhibit time is the least time between any two
    // transmissions of the PDO, so an answer to a request waits for its end as an event does.
    {"301", {254, 255}, {
      {"----..", {0}, "the state"},
      {"E---..", {0, 12, 14, 33}, "each change"},
      {"-T--..", {0, 24, 48, 72, 96}, "the timer"},
      {"--I-..", {0}, "sends nothing by itself"},
      {"---R..", {0, 5, 15, 17, 37}, "each request"},
      {"ET--..", {0, 12, 14, 33, 57, 81}, "24 ms after 33"},
      {"E-I-..", {0, 12, 21, 33}, "14 is put off to 12 + 9"},
      {"E--R..", {0, 5, 12, 14, 15, 17, 33, 37}, "each of both"},
      {"-TI-..", {0, 24, 48, 72, 96}, "the timer is longer"},
      {"-T-R..", {0, 5, 15, 17, 37, 61, 85}, "24 ms after 37"},
      {"--IR..", {0, 9, 18, 37}, "5 is put off to 9, 15 and 17 to 18"},
      {"ETI-..", {0, 12, 21, 33, 57, 81}, "14 is put off, 24 ms after 33"},
      {"ET-R..", {0, 5, 12, 14, 15, 17, 33, 37, 61, 85}, "24 ms after 37"},
      {"E-IR..", {0, 9, 18, 33, 42}, "12, 14, 15, 17 to 18; 37 to 42"},
      {"-TIR..", {0, 9, 18, 37, 61, 85}, "5 to 9; 15, 17 to 18; 24 ms after 37"},
      {"ETIR..", {0, 9, 18, 33, 42, 66, 90}, "as without timer, then 24 ms after 42"},
    }},

    // "The PDO is transmitted on an event-controlled basis with every sync"; events are changes "or
    // when a transmission cycle time has elapsed", here at 24 and 48.
    {"Lenze", {0}, {
      {"....-.", {}, "SYNC AND event"},
      {"--..S.", {10}, "SYNC AND event"},
      {"E-..S.", {10, 20, 40}, "a bit change there and back is an event"},
      {"-T..S.", {10, 30, 50}, "24 is sent at 30, 48 at 50"},
      {"ET..S.", {10, 20, 30, 40, 50}, "14, 24, 33, 48"},
    }},
    // The table of types in the manual has no column for "Polled via RTR" and says "RTR only" for
    // 252 and 253. So types below 252 follow CiA 301: no answer. The manual does not mention the
    // inhibit time here, so CiA 301 applies.
    {"Lenze", {1}, {
      {"....-.", {}, "sync-controlled"},
      {"....S.", {10, 20, 30, 40, 50}, "with every sync"},
    }},
    {"Lenze", {2}, {
      {"....-.", {}, "sync-controlled"},
      {"....S.", {20, 40}, "with every n-th sync"},
    }},
    {"Lenze", {252}, {
      {"...-..", {}, "RTR only"},
      {"...R-.", {}, "synchronous; before the first SYNC CiA 301: nothing was sampled"},
      {"...RS.", {15, 17, 37}, "synchronous - RTR only"},
    }},
    {"Lenze", {253}, {
      {"...-..", {}, "RTR only"},
      {"...R..", {5, 15, 17, 37}, "asynchronous - RTR only"},
    }},
    // "254 and 255 have the same meaning"; "cyclic transmission takes place in addition", so 24,
    // 48, 72 and 96 stay. An answer inside the inhibit time is delayed as in CiA 301.
    {"Lenze", {254, 255}, {
      {"----..", {0}, "the state, as CiA 301"},
      {"E---..", {0, 12, 14, 33}, "event-controlled"},
      {"-T--..", {0, 24, 48, 72, 96}, "cyclic"},
      {"--I-..", {0}, "nothing to put off"},
      {"---R..", {0, 5, 15, 17, 37}, "polled via RTR"},
      {"ET--..", {0, 12, 14, 24, 33, 48, 72, 96}, "event OR cycle"},
      {"E-I-..", {0, 12, 21, 33}, "14 is put off to 12 + 9"},
      {"E--R..", {0, 5, 12, 14, 15, 17, 33, 37}, "events and requests"},
      {"-TI-..", {0, 24, 48, 72, 96}, "the cycle is longer"},
      {"-T-R..", {0, 5, 15, 17, 24, 37, 48, 72, 96}, "the cycle stays"},
      {"--IR..", {0, 9, 18, 37}, "5 is put off to 9, 15 and 17 to 18"},
      {"ETI-..", {0, 12, 21, 30, 39, 48, 72, 96}, "14 to 21, 24 to 30, 33 to 39"},
      {"ET-R..", {0, 5, 12, 14, 15, 17, 24, 33, 37, 48, 72, 96}, "event OR cycle, and requests"},
      {"E-IR..", {0, 9, 18, 33, 42}, "12, 14, 15, 17 to 18; 37 to 42"},
      {"-TIR..", {0, 9, 18, 27, 37, 48, 72, 96}, "5 to 9; 15, 17 to 18; 24 to 27"},
      {"ETIR..", {0, 9, 18, 27, 36, 45, 54, 72, 96}, "24 to 27, 33 to 36, 37 to 45, 48 to 54"},
    }},

    // "Acquires its input data when it receives the SYNC and then transmits it if the data
    // correspond to an event". The manual does not mention an event timer for type 0. In CiA 301 it
    // belongs to types 254 and 255.
    {"Beckhoff", {0}, {
      {"....-.", {}, "acquired at SYNC"},
      {"-...S.", {10}, "the first sample, as CiA 301; then no event"},
      {"E...S.", {10, 40}, "the pulse of 12 to 14 is in no sample"},
    }},
    {"Beckhoff", {1}, {
      {"....-.", {}, "synchronous"},
      {"....S.", {10, 20, 30, 40, 50}, "after every SYNC"},
    }},
    {"Beckhoff", {2}, {
      {"....-.", {}, "synchronous"},
      {"....S.", {20, 40}, "after every nth SYNC"},
    }},
    {"Beckhoff", {252}, {
      {"...-..", {}, "only RTR"},
      {"...R-.", {}, "synchronous: CiA 301, nothing was sampled"},
      {"...RS.", {15, 17, 37}, "synchronous, only RTR"},
    }},
    {"Beckhoff", {253}, {
      {"...-..", {}, "only RTR"},
      {"...R..", {5, 15, 17, 37}, "asynchronous, only RTR"},
    }},
    // "Asynchronous"; the timer adds an event, and events reset it. The manual does not mention
    // requests and the inhibit time, so CiA 301 applies.
    {"Beckhoff", {254, 255}, {
      {"----..", {0}, "the state, as CiA 301"},
      {"E---..", {0, 12, 14, 33}, "each change"},
      {"-T--..", {0, 24, 48, 72, 96}, "an extra event"},
      {"--I-..", {0}, "CiA 301: sends nothing by itself"},
      {"---R..", {0, 5, 15, 17, 37}, "CiA 301: each request"},
      {"ET--..", {0, 12, 14, 33, 57, 81}, "events reset it"},
      {"E-I-..", {0, 12, 21, 33}, "CiA 301: 14 to 21"},
      {"E--R..", {0, 5, 12, 14, 15, 17, 33, 37}, "CiA 301: each of both"},
      {"-TI-..", {0, 24, 48, 72, 96}, "the timer is longer"},
      {"-T-R..", {0, 5, 15, 17, 37, 61, 85}, "CiA 301: begins anew with each frame"},
      {"--IR..", {0, 9, 18, 37}, "CiA 301: answers wait"},
      {"ETI-..", {0, 12, 21, 33, 57, 81}, "CiA 301: 14 to 21"},
      {"ET-R..", {0, 5, 12, 14, 15, 17, 33, 37, 61, 85}, "CiA 301"},
      {"E-IR..", {0, 9, 18, 33, 42}, "CiA 301: 12, 14, 15, 17 to 18; 37 to 42"},
      {"-TIR..", {0, 9, 18, 37, 61, 85}, "CiA 301: 5 to 9; 15, 17 to 18"},
      {"ETIR..", {0, 9, 18, 33, 42, 66, 90}, "CiA 301"},
    }},

    // "Which SYNC is given in the device profile": here the SYNC after the event, as in CiA 301.
    {"ars", {0}, {
      {"....-.", {}, "synchronous"},
      {"-...S.", {10}, "the state, as CiA 301"},
      {"E...S.", {10, 20, 40}, "the next SYNC"},
    }},
    {"ars", {1}, {
      {"....-.", {}, "after SYNC"},
      {"....S.", {10, 20, 30, 40, 50}, "after every SYNC"},
    }},
    {"ars", {2}, {
      {"....-.", {}, "after SYNC"},
      {"....S.", {20, 40}, "after every 2nd SYNC"},
    }},
    // "The data is updated on reception of a SYNC", so there is no data before the first one. The
    // page does not say which types have an inhibit time; in CiA 301 these are 254 and 255.
    {"ars", {252}, {
      {"...-..", {}, "only on reception of a request"},
      {"...R-.", {}, "never updated: CiA 301, no answer"},
      {"...RS.", {15, 17, 37}, "at 5 not updated yet: CiA 301, no answer"},
    }},
    {"ars", {253}, {
      {"...-..", {}, "on reception of a request"},
      {"...R..", {5, 15, 17, 37}, "updated and transmitted"},
    }},
    // "Each time the PDO is transmitted as a result of the event timer expiring, the event timer is
    // reset", so 24, 48, 72 and 96 stay. "Any additional transmissions of the PDO will not take
    // place during the inhibit time"; this includes answers, which are delayed as in CiA 301.
    {"ars", {254, 255}, {
      {"----..", {0}, "the state, as CiA 301"},
      {"E---..", {0, 12, 14, 33}, "each change"},
      {"-T--..", {0, 24, 48, 72, 96}, "every event time"},
      {"--I-..", {0}, "nothing to put off"},
      {"---R..", {0, 5, 15, 17, 37}, "polled individually"},
      {"ET--..", {0, 12, 14, 24, 33, 48, 72, 96}, "reset by its expiry only"},
      {"E-I-..", {0, 12, 21, 33}, "14 to 21"},
      {"E--R..", {0, 5, 12, 14, 15, 17, 33, 37}, "any of these methods can be combined"},
      {"-TI-..", {0, 24, 48, 72, 96}, "the event time is longer"},
      {"-T-R..", {0, 5, 15, 17, 24, 37, 48, 72, 96}, "reset by its expiry only"},
      {"--IR..", {0, 9, 18, 37}, "5 to 9; 15, 17 to 18"},
      {"ETI-..", {0, 12, 21, 30, 39, 48, 72, 96}, "14 to 21, 24 to 30, 33 to 39"},
      {"ET-R..", {0, 5, 12, 14, 15, 17, 24, 33, 37, 48, 72, 96}, "each of the three"},
      {"E-IR..", {0, 9, 18, 33, 42}, "12, 14, 15, 17 to 18; 37 to 42"},
      {"-TIR..", {0, 9, 18, 27, 37, 48, 72, 96}, "5 to 9; 15, 17 to 18; 24 to 27"},
      {"ETIR..", {0, 9, 18, 27, 36, 45, 54, 72, 96}, "24 to 27, 33 to 36, 37 to 45, 48 to 54"},
    }},

    // Table 3-11 of the manual has no types 0, 252 and 253, and the manual does not mention
    // requests. The disabled time is 90 ms, or 50 ms if the entry is 0.
    {"DRV-28", {1}, {
      {"....-.", {}, "synchronous"},
      {"....S.", {10, 20, 30, 40, 50}, "synchronous; timer, disabled time, RPDO are of 254, 255"},
    }},
    {"DRV-28", {2}, {
      {"....-.", {}, "synchronous"},
      {"....S.", {20, 40}, "synchronous; the manual gives n no other meaning than CiA 301"},
    }},
    {"DRV-28", {254}, {
      {"-T....", {24, 48, 72, 96}, "the timer is not zero: periodically"},
      {"ET....", {24, 48, 72, 96}, "not by changes"},
      {"--....", {}, "nothing changed"},
      {"E--...", {12, 62}, "once in 50 ms"},
      {"E-I...", {12, 102}, "once in 90 ms"},
    }},
    {"DRV-28", {255}, {
      {".T....", {24, 48, 72, 96}, "the timer is not zero: periodically"},
      {".-...-", {}, "no PDO Rx"},
      {".-...P", {11, 26}, "once its PDO Rx is received; the disabled time is of 254"},
    }},
};

// clang-format on

}  // namespace takt::test
