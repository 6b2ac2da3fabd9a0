#include "master/rt/status_board.hpp"

namespace takt {

StatusBoard::StatusBoard(std::size_t nodes, std::size_t tpdos)
    : nodes_{nodes},
      tpdos_{tpdos},
      lock_{8 * (seqlock_words<BusStatus> + nodes * seqlock_words<NodeStatus> +
                 tpdos * seqlock_words<PdoStatus>)} {}

void StatusBoard::read(StatusSnapshot& snapshot) const {
  snapshot.nodes.resize(nodes_);
  snapshot.tpdos.resize(tpdos_);
  lock_.read([&] {
    lock_.get(0, snapshot.bus);
    for (std::size_t i = 0; i < nodes_; ++i) lock_.get(node_at(i), snapshot.nodes[i]);
    for (std::size_t i = 0; i < tpdos_; ++i) lock_.get(tpdo_at(i), snapshot.tpdos[i]);
  });
}

}  // namespace takt
