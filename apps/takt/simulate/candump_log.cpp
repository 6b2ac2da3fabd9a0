#include "apps/takt/simulate/candump_log.hpp"

#include <array>
#include <cstdio>
#include <stdexcept>

namespace takt {

CandumpLog::CandumpLog(const BusPlan& plan, const std::string& path)
    : statistics_{plan}, bus_{plan.name} {
  if (path.empty()) return;
  file_.open(path);
  if (!file_) throw std::runtime_error{"can't write " + path};
  writes_ = true;
}

void CandumpLog::on_wire(const sim::WireFrame& wire) noexcept {
  statistics_.on_wire(wire);
  if (writes_ && wire.result == sim::WireResult::sent) write(wire);
}

void CandumpLog::write(const sim::WireFrame& wire) noexcept {
  std::array<char, 96> text{};
  const long long us = wire.end.count() / 1000;
  const Frame& frame = wire.frame;
  int at = std::snprintf(text.data(), text.size(), "(%lld.%06lld) %.32s ", us / 1'000'000,
                         us % 1'000'000, bus_.c_str());
  at += std::snprintf(text.data() + at, text.size() - static_cast<std::size_t>(at),
                      frame.id.is_extended() ? "%08X#%s" : "%03X#%s",
                      static_cast<unsigned>(frame.id.id()), frame.rtr ? "R" : "");
  for (std::size_t i = 0; i < frame.length && !frame.rtr; ++i) {
    at += std::snprintf(text.data() + at, text.size() - static_cast<std::size_t>(at), "%02X",
                        frame.data[i]);
  }
  file_ << text.data() << '\n';
}

}  // namespace takt
