/* Signals that ask the program to stop. main holds them back (held_signals.c), so that they stay pending. */
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <time.h>
#include <unistd.h>

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

/* By the first of both threads that notices the signal: the run may end before the other one looks. */
void implam_announce_stop(void)
{
  static atomic_flag said = ATOMIC_FLAG_INIT;
  static const char words[] = "\nimplam: signal received. The step in progress is being finished; then a checkpoint is "
                              "written and the run ends.\n";
  if (atomic_flag_test_and_set(&said)) return;
  if (write(STDERR_FILENO, words, sizeof words - 1) < 0) return;
}

/* Looks ten times a second, which a reader takes for at once: a signal that is held back stays pending and wakes no
 * thread, and one that were waited for would be gone when the run asks for it. */
static void *watch(void *unused)
{
  const struct timespec pause = {0, 100000000};
  (void)unused;
  while (implam_stop_signal() == 0) nanosleep(&pause, NULL);
  implam_announce_stop();
  return NULL;
}

void implam_announce_stop_signals(void)
{
  pthread_t watcher;
  if (pthread_create(&watcher, NULL, watch, NULL) == 0) pthread_detach(watcher);
}
