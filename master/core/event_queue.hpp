#pragma once
#include "master/core/event.hpp"
#include "master/core/fixed_queue.hpp"

namespace takt {

/// Holds the events of one cycle until they are moved to the ring buffer of the front thread. Bus
/// thread only.
using EventQueue = FixedQueue<Event, 256>;

}  // namespace takt
