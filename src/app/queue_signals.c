/* Remembers that a queue (or a person) asked the program to stop. Signal handlers can be neither
   written nor safely given memory in Fortran; this flag is all that lives outside it. */
#include <signal.h>

static volatile sig_atomic_t stop_asked = 0;

static void remember(int signal_number) { stop_asked = signal_number; }

void implam_catch_stop_signals(void)
{
  const int caught[] = {SIGTERM, SIGINT, SIGUSR1, SIGUSR2, SIGXCPU};
  struct sigaction action = {0};
  action.sa_handler = remember;
  for (unsigned i = 0; i < sizeof caught / sizeof caught[0]; ++i) sigaction(caught[i], &action, 0);
}

int implam_stop_signal(void) { return (int)stop_asked; }
