#include "test/simulate/random_network.hpp"

#include <fstream>
#include <gtest/gtest.h>

#include "test/support/folder.hpp"

namespace takt {
namespace {

std::string drive(sim::Random& random) {
  static constexpr const char* first[] = {"{index: 0x6041}, {index: 0x6064}", "{index: 0x6041}"};
  const bool second = random.chance(0.5);
  return std::string{"{dcf: "} + TAKT_SOURCE_DIR +
         "/share/eds/takt_drive402.eds, profile: cia402, tpdo: {1: {transmission: 1, cob_id: auto, "
         "mapping: [" +
         first[random.below(2)] + "]}, 2: {" +
         (second ? "transmission: 1, cob_id: auto, mapping: [{index: 0x606C}, {index: 0x6077}, "
                   "{index: 0x6061}]"
                 : "enabled: false") +
         "}, 3: {enabled: false}, 4: {enabled: false}}, rpdo: {1: {transmission: 1, cob_id: auto, "
         "mapping: [{index: 0x6040}, {index: 0x607A}]}, 2: {transmission: 1, cob_id: auto, "
         "mapping: [{index: 0x6060}]}, 3: {enabled: false}, 4: {enabled: false}}";
}

std::string io(sim::Random& random) {
  const auto n = std::to_string(1 + random.below(2));
  return std::string{"{dcf: "} + TAKT_SOURCE_DIR +
         "/share/eds/takt_io401.eds, tpdo: {1: {transmission: " + n +
         ", cob_id: auto}, 2: {transmission: 255, inhibit_time: " +
         std::to_string(50 + random.below(500)) + "}}, rpdo: {1: {transmission: 1, cob_id: auto}}";
}

}  // namespace

LoadedNetwork random_network(sim::Random& random) {
  static constexpr unsigned rates[] = {250, 500, 1000};
  const unsigned rate = rates[random.below(3)];
  const unsigned nodes = 1 + random.below(10);
  const unsigned us = (200 + nodes * 600) * 1000 / rate * (9 + random.below(12)) / 10;
  std::string text = "bus: {name: random, bitrate_kbit: " + std::to_string(rate) +
                     "}\nmaster: {sync_period: " + std::to_string(us) +
                     ", heartbeat_producer: " + std::to_string(40 + random.below(100)) +
                     "}\nnodes:\n";
  for (unsigned i = 1; i <= nodes; ++i) {
    text += "  n" + std::to_string(i) + ": " + (random.chance(0.7) ? drive(random) : io(random)) +
            ", node_id: " + std::to_string(3 * i) +
            ", heartbeat_producer: " + std::to_string(31 + random.below(90)) + "}\n";
  }
  const test::Folder folder;
  return load_network(folder.write("random.yaml", text));
}

}  // namespace takt
