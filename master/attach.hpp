#pragma once
#include <memory>

#include "eds_parser/table/bus_plan.hpp"
#include "master/master_run.hpp"
#include "master/rt/bus_loop.hpp"
#include "master/rt/exchange/exchange.hpp"
#include "master/rt/journal/recorded_link.hpp"
#include "master/rt/journal/recorded_port.hpp"

namespace takt {

/// The bus loop of a MasterRun, compiled for one kind of port.
template <Port P>
class PortRunner final : public MasterRun::Runner {
 public:
  PortRunner(const BusPlan& plan, P& port, Journal* journal, Exchange& exchange,
             const MasterRunOptions& options)
      : port_{port, journal},
        loop_{plan,
              port_,
              RecordedLink{exchange, journal},
              {.observe = options.observe, .controller = options.controller}} {}
  void start() noexcept override { loop_.start(); }
  void cycle() noexcept override { loop_.cycle(); }
  bool done() const noexcept override { return loop_.done(); }

 private:
  RecordedPort<P> port_;
  BusLoop<RecordedPort<P>, RecordedLink> loop_;
};

template <Port P>
void MasterRun::attach(P& port, Journal* journal) {
  runner_ = std::make_unique<PortRunner<P>>(plan_, port, journal, *exchange_, options_);
}

}  // namespace takt
