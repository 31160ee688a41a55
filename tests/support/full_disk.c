/* Loaded before a program (LD_PRELOAD), lets one write at a position in a file, as by HDF5, fail: the one with the
   number FULL_AT, unless it is 0, with the system's error FULL_ERROR, by default that of a full disk. After it trial
   files cannot be written. At the end the file FULL_COUNT contains the number of writes, unless there were none. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

static long writes;
static int error;

static int is_trial(int file)
{
  char link[64], path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length < 6) return 0;
  path[length] = 0;
  return strcmp(path + length - 6, ".trial") == 0;
}

ssize_t pwrite(int file, const void *bytes, size_t length, off_t place)
{
  ssize_t (*real)(int, const void *, size_t, off_t) =
    (ssize_t (*)(int, const void *, size_t, off_t))dlsym(RTLD_NEXT, "pwrite");
  const char *at = getenv("FULL_AT"), *number = getenv("FULL_ERROR");
  if (error && is_trial(file)) {
    errno = error;
    return -1;
  }
  writes++;
  if (at && writes == atol(at)) {
    error = number ? atoi(number) : ENOSPC;
    errno = error;
    return -1;
  }
  return real(file, bytes, length, place);
}

__attribute__((destructor)) static void at_exit(void)
{
  const char *path = getenv("FULL_COUNT");
  FILE *file = path && writes ? fopen(path, "w") : NULL;
  if (!file) return;
  fprintf(file, "%ld\n", writes);
  fclose(file);
}
