#include "master/rt/exchange/status_board.hpp"

namespace takt {

StatusBoard::StatusBoard(std::size_t nodes, std::size_t tpdos, std::size_t rpdos)
    : nodes_{nodes},
      tpdos_{tpdos},
      rpdos_{rpdos},
      lock_{8 * (seqlock_words<BusStatus> + nodes * seqlock_words<NodeStatus> +
                 tpdos * seqlock_words<PdoStatus> + rpdos * seqlock_words<RpdoStatus>)} {}

void StatusBoard::read(StatusSnapshot& snapshot) const {
  snapshot.nodes.resize(nodes_);
  snapshot.tpdos.resize(tpdos_);
  snapshot.rpdos.resize(rpdos_);
  lock_.read([&] {
    lock_.get(0, snapshot.bus);
    for (std::size_t i = 0; i < nodes_; ++i) lock_.get(node_at(i), snapshot.nodes[i]);
    for (std::size_t i = 0; i < tpdos_; ++i) lock_.get(tpdo_at(i), snapshot.tpdos[i]);
    for (std::size_t i = 0; i < rpdos_; ++i) lock_.get(rpdo_at(i), snapshot.rpdos[i]);
  });
}

}  // namespace takt
