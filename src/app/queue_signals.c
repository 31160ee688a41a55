/* Signals that ask the program to stop. main holds them back (held_signals.c), so that they stay pending. */
#include <signal.h>
#include <stddef.h>

static const int stops[] = {SIGTERM, SIGINT, SIGUSR1, SIGUSR2, SIGXCPU};
enum { number = sizeof stops / sizeof stops[0] };

int implam_stop_signal(void)
{
  sigset_t pending;
  if (sigpending(&pending) != 0) return 0;
  for (unsigned i = 0; i < number; ++i)
    if (sigismember(&pending, stops[i]) == 1) return stops[i];
  return 0;
}

void implam_release_stop_signals(void)
{
  sigset_t set;
  sigemptyset(&set);
  for (unsigned i = 0; i < number; ++i) sigaddset(&set, stops[i]);
  sigprocmask(SIG_UNBLOCK, &set, NULL);
}
