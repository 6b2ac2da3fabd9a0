#pragma once
#include <cstdio>
#include <fmt/format.h>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "apps/takt/simulate/candump_log.hpp"

namespace takt::soak {

/// Prints a line of `--verbose` on stderr, with its time.
inline void print_at(Time when, std::string_view text) {
  fmt::print(stderr, "{:12.3f} ms  {}\n", 1e-6 * static_cast<double>(when.count()), text);
}

/// Passes the frames on the wire to a judge and, if a file is named, writes them as `candump -L`.
class Listener final : public sim::BusObserver {
 public:
  using Judge = std::function<void(const sim::WireFrame& wire)>;

  Listener(const BusPlan& plan, const std::string& candump, Judge judge)
      : judge_{std::move(judge)} {
    if (!candump.empty()) log_ = std::make_unique<CandumpLog>(plan, candump);
  }
  void on_wire(const sim::WireFrame& wire) noexcept override {
    judge_(wire);
    if (log_) log_->on_wire(wire);
  }

 private:
  Judge judge_;
  std::unique_ptr<CandumpLog> log_;
};

}  // namespace takt::soak
