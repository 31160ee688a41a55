/* Loaded ahead of a program (LD_PRELOAD), the disk is full for one write at a place in a file, as HDF5 writes: that
   numbered FULL_AT, if it is not 0. The file FULL_COUNT receives their number at the end. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/types.h>

static long writes;

ssize_t pwrite(int file, const void *bytes, size_t length, off_t place)
{
  ssize_t (*real)(int, const void *, size_t, off_t) =
    (ssize_t (*)(int, const void *, size_t, off_t))dlsym(RTLD_NEXT, "pwrite");
  const char *at = getenv("FULL_AT");
  writes++;
  if (at && writes == atol(at)) {
    errno = ENOSPC;
    return -1;
  }
  return real(file, bytes, length, place);
}

__attribute__((destructor)) static void at_exit(void)
{
  const char *path = getenv("FULL_COUNT");
  FILE *file = path ? fopen(path, "w") : NULL;
  if (!file) return;
  fprintf(file, "%ld\n", writes);
  fclose(file);
}
