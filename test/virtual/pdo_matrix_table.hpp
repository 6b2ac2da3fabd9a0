#pragma once
// The times at which simulated devices send PDOs, derived by hand from CiA 301 and from four
// manuals.
#include <cstdint>
#include <span>
#include <vector>

#include "test/virtual/pdo_matrix_301.hpp"
#include "test/virtual/pdo_matrix_families.hpp"

namespace takt::test {

// clang-format off

/// An interpretation of the transmission types by a device.
struct Reading {
  const char* name;
  const char* model;  ///< model of the simulated device; "" means CiA 301
  const char* quirk;
  std::span<const TpdoRow> rows;
};

inline const std::vector<Reading> readings{
    {"301", "", "", rows_301},
    {"plain 301", "plain301", "", rows_301},
    {"Lenze", "lenze8400", "", rows_lenze},
    {"Beckhoff", "beckhoff", "", rows_beckhoff},
    {"ars", "plain301", "event_timer_raster", rows_ars},
    {"DRV-28", "astraada_drv28", "", rows_drv28},
};

/// The TPDO types out of 0..255 that a device refuses besides 241..251.
struct TypesRow {
  const char* name;
  const char* model;
  std::vector<int> refused;
};

inline const std::vector<TypesRow> types_rows{
    {"301", "", {}},
    {"Lenze: reserved are 241 to 251", "lenze8400", {}},
    {"Beckhoff: reserved are 241 to 251", "beckhoff", {}},
    {"ars: not used are 241 to 251", "plain301", {}},
    {"DRV-28: its table 3-11 has 1 to 240, 254 and 255", "astraada_drv28", {0, 252, 253}},
};

/// Whether a device refuses to enable a TPDO of this type whose COB-ID has bit 30 set (no remote
/// requests).
struct Bit30Row {
  const char* name;
  std::uint8_t type;
  bool refused;
};

inline const std::vector<Bit30Row> bit30_rows{
    {"1: never asked for", 1, false},
    {"252: nobody could ask for it", 252, true},
    {"253: nobody could ask for it", 253, true},
    {"254: sent by events", 254, false},
    {"255: sent by events", 255, false},
};

/// SYNC start value: SYNC number k (at 10 k ms) carries the counter (k - 1) mod overflow + 1.
struct StartRow {
  const char* name;
  std::uint8_t type;
  std::uint8_t start;
  std::uint8_t overflow;
  std::vector<int> syncs;  ///< SYNCs out of the first 21 that a frame follows
};

inline const std::vector<StartRow> start_rows{
    {"n 3, start 2 of 10: counters 2 5 8 1 4 7 10", 3, 2, 10, {2, 5, 8, 11, 14, 17, 20}},
    {"n 4, start 3 of 8: counters 3 7 3 7", 4, 3, 8, {3, 7, 11, 15, 19}},
    {"n 1, start 5 of 10", 1, 5, 10, {5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20,
      21}},
    {"no counter: the start value means nothing", 3, 2, 0, {3, 6, 9, 12, 15, 18, 21}},
    {"start 0: any", 3, 0, 10, {3, 6, 9, 12, 15, 18, 21}},
};

/// The device is configured to produce SYNC itself every 20 ms. Lenze: "from version 16.00.00
/// onwards, the transmit PDOs are also sent when the sync telegram is generated. Precondition: the
/// sync Tx identifier and sync Rx identifier have the same value". The manual says this for types 1
/// to 240. The precondition makes the device's own SYNC a received one, so for types 0 and 252,
/// which the manual does not mention, it counts as a SYNC of CiA 301.
struct OwnSyncRow {
  const char* name;
  const char* model;
  const char* firmware;
  std::uint16_t transmit_id;
  std::uint8_t type;
  std::vector<int> syncs;   ///< times of SYNCs within 100 ms
  std::vector<int> frames;  ///< times of frames within 100 ms
  Course course{};          ///< changes and remote requests
};

inline const std::vector<int> each_20{20, 40, 60, 80, 100};

inline const std::vector<OwnSyncRow> own_sync_rows{
    {"Lenze, type 1", "lenze8400", "16.00.00", 0x080, 1, each_20, each_20},
    {"Lenze, type 2", "lenze8400", "16.00.00", 0x080, 2, each_20, {40, 80}},
    {"Lenze, type 0: no event", "lenze8400", "16.00.00", 0x080, 0, each_20, {20}},
    {"Lenze, type 0: the SYNC after the event", "lenze8400", "16.00.00", 0x080, 0, each_20,
      {20, 60, 80}, {.changes = {45, 50, 65}}},
    {"Lenze, type 0, older firmware", "lenze8400", "15.02.00", 0x080, 0, each_20, {},
      {.changes = {45}}},
    {"Lenze, type 0, another identifier", "lenze8400", "16.00.00", 0x090, 0, each_20, {},
      {.changes = {45}}},
    {"Lenze, type 252: sampled at the first", "lenze8400", "16.00.00", 0x080, 252, each_20, {25, 31},
      {.remote = {5, 25, 31}}},
    {"Lenze, type 252, older firmware: never sampled", "lenze8400", "15.02.00", 0x080, 252, each_20,
      {}, {.remote = {5, 25}}},
    {"Lenze, type 253: not by SYNC", "lenze8400", "16.00.00", 0x080, 253, each_20, {5, 25},
      {.remote = {5, 25}}},
    {"Lenze, type 255: not by SYNC", "lenze8400", "16.00.00", 0x080, 255, each_20, {0}},
    {"Lenze, newer firmware", "lenze8400", "17.01.00", 0x080, 1, each_20, each_20},
    {"Lenze, older firmware", "lenze8400", "15.02.00", 0x080, 1, each_20, {}},
    {"Lenze, another identifier", "lenze8400", "16.00.00", 0x090, 1, each_20, {}},
    {"301: who makes no SYNC refuses bit 30 of 0x1005", "", "", 0x080, 1, {}, {}},
};

/// Frames of higher priority occupy the wire from `from` to `until`, in ms; if both are 0, the bus
/// is free. ars: "the inhibit time is measured from the time when the node first attempts to send",
/// "after every nth SYNC Object within the Synchronous Window Length".
struct BlockedRow {
  std::uint8_t type;
  const char* name;
  int from;
  int until;
  Course course;
  std::vector<int> frames;  ///< start times on the wire
  int window = 0;           ///< SYNC window 0x1007 in ms; 0 means none
};

inline const std::vector<BlockedRow> blocked_rows{
    {255, "I+E: attempts at 20 and 30", 0, 0, {.inhibit = 100, .changes = {20, 22}}, {0, 20, 30}},
    {255, "I+E: 'the delay is included in the inhibit time'", 15, 28,
      {.inhibit = 100, .changes = {20, 22}}, {0, 28, 30}},
    {255, "I+E: blocked for longer than that, so one right after the other", 15, 34,
      {.inhibit = 100, .changes = {20, 22}}, {0, 34, 34}},
    {255, "I+T: attempts at 50 and 100", 49, 70, {.inhibit = 400, .timer = 50},
      {0, 70, 100, 150, 200}},
    {255, "I+T: blocked for two event times", 49, 101, {.inhibit = 400, .timer = 50},
      {0, 101, 101, 150, 200}},
    {1, "S: on a free bus", 0, 0, {.syncs = {20, 40}}, {20, 40}, 5},
    {1, "S: no window, late", 19, 28, {.syncs = {20, 40}}, {28, 40}},
    {1, "S: late, but within the window", 19, 28, {.syncs = {20, 40}}, {28, 40}, 10},
    {1, "S: after the window not at all", 19, 28, {.syncs = {20, 40}}, {40}, 5},
};

/// The times of RPDO2, of SYNCs, and of the moments at which the value acts, in ms after NMT start.
/// Beckhoff: "RxPDOs do not generally distinguish between transmission types 0...240: a PDO that
/// has been received is set to valid when the next SYNC is received".
struct RpdoRow {
  std::uint8_t type;
  const char* name;
  std::vector<int> rpdos;
  std::vector<int> syncs;
  std::vector<int> acts;
};

inline const std::vector<RpdoRow> rpdo_rows{
    {0, "without SYNC never", {12}, {}, {}},
    {0, "at the next SYNC", {12, 33}, each_10, {20, 40}},
    {0, "two before a SYNC: the later one", {12, 14}, each_10, {20}},
    {1, "without SYNC never", {12}, {}, {}},
    {1, "at the next SYNC", {12, 33}, each_10, {20, 40}},
    {1, "two before a SYNC: the later one", {12, 14}, each_10, {20}},
    {17, "at the next SYNC, not at the 17th", {12, 33}, each_10, {20, 40}},
    {240, "at the next SYNC, not at the 240th", {12, 33}, each_10, {20, 40}},
    {254, "at once, without SYNC", {12, 14, 33}, {}, {12, 14, 33}},
    {254, "at once", {12, 14, 33}, each_10, {12, 14, 33}},
    {255, "at once, without SYNC", {12, 14, 33}, {}, {12, 14, 33}},
    {255, "at once", {12, 14, 33}, each_10, {12, 14, 33}},
};

// clang-format on

}  // namespace takt::test
