/* Preloaded into user-mode-linux. It gives the guest a separate clock, which a busy host does not
 * disturb.
 *
 * The guest's time is the processor time that it has used, divided by `speed`, plus the time that
 * it was idle. When it has nothing to do, its clock is moved to its next timer at once. While the
 * host runs other processes, the guest's clock stands still. So no program in the guest is late
 * because of the host, and a test that waits costs no time.
 *
 * UML 6.1 reads one clock (CLOCK_MONOTONIC), sets one timer of the host, and sleeps in sigsuspend.
 * It runs a process of the guest as a process of the host that it traces, and waits for that in
 * waitpid. These are the functions that are replaced here. UML calls all of them from one thread.
 */
#include <dlfcn.h>
#include <errno.h>
#include <sched.h>
#include <signal.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <time.h>

typedef long long Nanoseconds;

enum { second = 1000000000 };

static int speed = 1; /* The guest's processor is so many times as fast as that of the host. */

static int (*host_clock_gettime)(clockid_t, struct timespec*);
static int (*host_timer_settime)(timer_t, int, const struct itimerspec*, struct itimerspec*);
static int (*host_sigaction)(int, const struct sigaction*, struct sigaction*);
static int (*host_sigsuspend)(const sigset_t*);
static pid_t (*host_waitpid)(pid_t, int*, int);
static int (*host_clone)(int (*)(void*), void*, int, void*, ...);

/* An alarm makes UML read its clock after `look_again` of the host's time, so a reading finds little
 * more processor time than that. If a reading finds more than `longest_step`, there are two possible
 * causes: the machine was paused below the host, which counts the pause as processor time, or a host
 * process has got the process id of a guest process that has ended. In both cases no process of the
 * guest has worked in this time. It then counts as 1.5 ms of the guest, which is less than a cycle
 * of the buses in the tests. */
static const Nanoseconds look_again = 5000000;
static const Nanoseconds longest_step = 12000000;

static Nanoseconds idle;         /* the sum of all jumps */
static Nanoseconds seen;         /* processor time at the last look */
static Nanoseconds lost;         /* processor time in which nobody in the guest has worked */
static Nanoseconds of_processes; /* processor time of the guest's processes */
static Nanoseconds booted;       /* processor time that the kernel took until its first process */
static pid_t last;               /* the process that UML waited for last; the others stand still */
static Nanoseconds counted;      /* its processor time that is in of_processes */
static Nanoseconds expiry = -1;  /* of the guest's timer, by the guest's clock; -1: it is off */
static Nanoseconds interval;
static timer_t timer;
static void (*guest_alarm)(int, siginfo_t*, void*);

static Nanoseconds of(struct timespec time) {
  return (Nanoseconds)time.tv_sec * second + time.tv_nsec;
}

static struct timespec to_timespec(Nanoseconds time) {
  return (struct timespec){time / second, time % second};
}

static Nanoseconds processor_time(clockid_t clock) {
  struct timespec time;
  return host_clock_gettime(clock, &time) == 0 ? of(time) : -1;
}

static clockid_t clock_of(pid_t process) { return (clockid_t)(~(unsigned)process << 3 | 2); }

static void count(void) {
  const Nanoseconds more = last ? processor_time(clock_of(last)) - counted : 0;
  if (more <= 0) return; /* It has ended. */
  counted += more;
  of_processes += more;
}

static Nanoseconds used(void) {
  count();
  const Nanoseconds found = processor_time(CLOCK_PROCESS_CPUTIME_ID) + of_processes - lost;
  const Nanoseconds step = found - seen;
  const Nanoseconds more = speed > 1 && step > longest_step ? step - longest_step : 0;
  lost += more;
  seen = found - more;
  return seen;
}

static Nanoseconds now(void) { return idle + (used() - booted) / speed + booted; }

/* The processor time of the guest grows more slowly than the host's clock, so the host's timer is
 * never too late. An alarm that comes too early sets the next one. */
static void arm(Nanoseconds left) {
  Nanoseconds host = left > 0 ? left * speed : 1;
  if (speed > 1 && host > look_again) host = look_again;
  host_timer_settime(timer, 0, &(struct itimerspec){{0, 0}, to_timespec(host)}, NULL);
}

static void on_alarm(int number, siginfo_t* information, void* context) {
  const int error = errno;
  const Nanoseconds left = expiry - now();
  if (expiry >= 0 && left > 0) {
    arm(left);
  } else {
    const int due = expiry >= 0;
    expiry = due && interval > 0 ? expiry + interval : -1;
    if (expiry >= 0) arm(expiry - now());
    if (due) guest_alarm(number, information, context);
  }
  errno = error;
}

int clock_gettime(clockid_t clock, struct timespec* time) {
  if (clock != CLOCK_MONOTONIC) return host_clock_gettime(clock, time);
  *time = to_timespec(now());
  return 0;
}

int timer_settime(timer_t which, int flags, const struct itimerspec* wanted,
                  struct itimerspec* old) {
  (void)flags, (void)old;
  timer = which;
  const Nanoseconds left = of(wanted->it_value);
  interval = of(wanted->it_interval);
  expiry = left > 0 ? now() + left : -1;
  if (left > 0) {
    arm(left);
    return 0;
  }
  return host_timer_settime(which, 0, wanted, NULL);
}

int timer_gettime(timer_t which, struct itimerspec* found) {
  (void)which;
  const Nanoseconds left = expiry < 0 ? 0 : expiry - now();
  *found =
      (struct itimerspec){to_timespec(interval), to_timespec(expiry >= 0 && left < 1 ? 1 : left)};
  return 0;
}

int sigaction(int number, const struct sigaction* wanted, struct sigaction* old) {
  if (number != SIGALRM || !wanted || !(wanted->sa_flags & SA_SIGINFO))
    return host_sigaction(number, wanted, old);
  struct sigaction mine = *wanted;
  guest_alarm = wanted->sa_sigaction;
  mine.sa_sigaction = on_alarm;
  return host_sigaction(number, &mine, old);
}

/* UML has nothing to do: SIGALRM is blocked except in here. Another signal that waits comes before
 * the jump. */
int sigsuspend(const sigset_t* mask) {
  sigset_t pending;
  sigpending(&pending);
  if (expiry >= 0 && !sigismember(&pending, SIGIO)) {
    const Nanoseconds left = expiry - now();
    if (left > 0) idle += left;
    arm(0);
  }
  return host_sigsuspend(mask);
}

/* The kernel measures the processor in ticks of its clock when it starts, so the guest is fast only
 * from its first process on. Threads of UML itself share its memory. */
int clone(int (*function)(void*), void* stack, int flags, void* argument, ...) {
  if (!(flags & CLONE_VM) && speed == 1) {
    booted = used();
    speed = 8;
  }
  return host_clone(function, stack, flags, argument);
}

pid_t waitpid(pid_t process, int* status, int options) {
  if (process <= 0) return host_waitpid(process, status, options);
  if (process != last) {
    count();
    last = process;
    counted = processor_time(clock_of(process));
  }
  int found = 0;
  const pid_t heard = host_waitpid(process, &found, options);
  const int has_ended = heard > 0 && (WIFEXITED(found) || WIFSIGNALED(found));
  if (has_ended) last = 0; /* The host may give its number to another process. */
  if (heard > 0 && status) *status = found;
  return heard;
}

__attribute__((constructor)) static void find_functions(void) {
  *(void**)&host_clock_gettime = dlsym(RTLD_NEXT, "clock_gettime");
  *(void**)&host_timer_settime = dlsym(RTLD_NEXT, "timer_settime");
  *(void**)&host_sigaction = dlsym(RTLD_NEXT, "sigaction");
  *(void**)&host_sigsuspend = dlsym(RTLD_NEXT, "sigsuspend");
  *(void**)&host_waitpid = dlsym(RTLD_NEXT, "waitpid");
  *(void**)&host_clone = dlsym(RTLD_NEXT, "clone");
}
