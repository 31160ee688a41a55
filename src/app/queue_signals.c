/* Remembers that a queue (or a person) asked the program to stop. Signal handlers can be neither
   written nor safely given memory in Fortran; this flag is all that lives outside it. */
#include <signal.h>

static volatile sig_atomic_t stop_asked = 0;

static void remember(int signal_number);

static void catch_signal(int signal_number)
{
  struct sigaction action = {0};
  action.sa_handler = remember;
  action.sa_flags = SA_RESTART;
  sigaction(signal_number, &action, 0);
}

/* A library that has borrowed the signal may have given it back for one time only; the next one often comes at once:
   Slurm signals every process, and mpirun passes on to them what it gets. */
static void remember(int signal_number)
{
  catch_signal(signal_number);
  stop_asked = signal_number;
}

void implam_catch_stop_signals(void)
{
  const int caught[] = {SIGTERM, SIGINT, SIGUSR1, SIGUSR2, SIGXCPU};
  for (unsigned i = 0; i < sizeof caught / sizeof caught[0]; ++i) catch_signal(caught[i]);
}

int implam_stop_signal(void) { return (int)stop_asked; }
