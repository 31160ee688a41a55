/* Loaded ahead of a program (LD_PRELOAD), the disk is full for one write at a place in a file, as HDF5 writes: that
   numbered FULL_AT, if it is not 0. From then on the system says that no space is left. The file FULL_COUNT receives
   the number of writes at the end. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/statvfs.h>
#include <sys/types.h>

static long writes;
static int is_full;

ssize_t pwrite(int file, const void *bytes, size_t length, off_t place)
{
  ssize_t (*real)(int, const void *, size_t, off_t) =
    (ssize_t (*)(int, const void *, size_t, off_t))dlsym(RTLD_NEXT, "pwrite");
  const char *at = getenv("FULL_AT");
  writes++;
  if (at && writes == atol(at)) {
    is_full = 1;
    errno = ENOSPC;
    return -1;
  }
  return real(file, bytes, length, place);
}

int statvfs(const char *path, struct statvfs *disk)
{
  int (*real)(const char *, struct statvfs *) =
    (int (*)(const char *, struct statvfs *))dlsym(RTLD_NEXT, "statvfs");
  const int status = real(path, disk);
  if (status == 0 && is_full) disk->f_bavail = 0;
  return status;
}

__attribute__((destructor)) static void at_exit(void)
{
  const char *path = getenv("FULL_COUNT");
  FILE *file = path ? fopen(path, "w") : NULL;
  if (!file) return;
  fprintf(file, "%ld\n", writes);
  fclose(file);
}
