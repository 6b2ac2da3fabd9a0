#pragma once
#include <takt/network.hpp>
#include <vector>

#include "eds_parser/network_file/load_network.hpp"

namespace takt {

struct NetworkFile::State {
  LoadedNetwork loaded;
  std::vector<NetworkFinding> findings;
  std::vector<NetworkNode> nodes;
  std::vector<ImageSignal> signals;
};

}  // namespace takt
