#pragma once
#include "master/core/event.hpp"
#include "master/core/fixed_queue.hpp"

namespace takt {

/// Events of the bus thread on their way to the front thread's ring.
using EventQueue = FixedQueue<Event, 256>;

}  // namespace takt
