#pragma once
#include "master/core/event.hpp"
#include "master/core/fixed_queue.hpp"

namespace takt {

/// Events of one cycle on their way to the front thread's ring. Bus thread only.
using EventQueue = FixedQueue<Event, 256>;

}  // namespace takt
