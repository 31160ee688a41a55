/* The signals by which a queue (or a person) stops a run are held back from the first instruction on, before any
   library's own start: they stay pending until the run looks for them (app/queue_signals). Every thread that a library
   starts inherits that. So no moment is left at which one ends the program without a checkpoint, and no library that
   borrows such a signal, as METIS does with TERM to jump out of its work, is ever handed one. */
#include <signal.h>
#include <stddef.h>

static void hold_stop_signals(int words, char **command, char **environment)
{
  const int held[] = {SIGTERM, SIGINT, SIGUSR1, SIGUSR2, SIGXCPU};
  sigset_t set;
  (void)words, (void)command, (void)environment;
  sigemptyset(&set);
  for (unsigned i = 0; i < sizeof held / sizeof held[0]; ++i) sigaddset(&set, held[i]);
  sigprocmask(SIG_BLOCK, &set, NULL);
}

/* The linker's list of what comes before the starts of shared libraries. */
__attribute__((section(".preinit_array"), used)) static void (*const first)(int, char **, char **) = hold_stop_signals;
