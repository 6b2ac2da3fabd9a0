#pragma once
#include "master/core/event.hpp"
#include "master/core/fixed_queue.hpp"

namespace takt {

/// The events of one cycle until they move to the ring of the front thread. Bus thread only.
using EventQueue = FixedQueue<Event, 256>;

}  // namespace takt
