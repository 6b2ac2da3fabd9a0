#pragma once
#include <expected>
#include <functional>
#include <thread>

#include "eds_parser/table/run_options.hpp"
#include "master/linux/rt_thread.hpp"

namespace takt {

/// A started bus thread and what the machine has granted it. If the report says that the thread may
/// not run, its body is left out.
struct BusThread {
  std::thread thread;
  RtReport report;
};

/// Starts the thread `takt-bus` with real-time properties, and returns when the report is known.
/// Returns the errno if the machine refuses another thread.
std::expected<BusThread, int> start_bus_thread(const RealtimeOptions& options,
                                               std::function<void()> body);

}  // namespace takt
