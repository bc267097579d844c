// A thread that the scheduler lets run as soon as it wants to.
#pragma once

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>

namespace dynamixel {

/// Asks for that of the calling thread; threads it starts have it too. `priority`: 1 (least) ... 99. False without the
/// right to it (root, or "rtprio" in /etc/security/limits.conf). In either case timers are exact from then on, and the
/// memory of the program stays in memory where the system allows it.
inline bool ask_for_realtime(int priority = 50) {
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT);
  sched_param parameters{};
  parameters.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

}  // namespace dynamixel
