/* Age, kind and identity of files, and space on disks. They are in structures that each system lays out in its own
   way, so this is written in its language. */
#define _POSIX_C_SOURCE 200809L
#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>

struct entry {
  struct timespec time;
  char name[256];
};

static int is_newer(const struct entry *a, const struct entry *b)
{
  if (a->time.tv_sec != b->time.tv_sec) return a->time.tv_sec > b->time.tv_sec;
  if (a->time.tv_nsec != b->time.tv_nsec) return a->time.tv_nsec > b->time.tv_nsec;
  return strcmp(a->name, b->name) > 0;
}

/* The newest regular file whose name ends as given, or the newest of those older than the one found before, which
   `found` says and is not empty then. Returns 1, or 0 if there is none; names too long for a path are passed over. */
static int next_older(const char *folder, const char *ending, struct entry *found)
{
  const struct entry bound = *found;
  const size_t length = strlen(ending);
  DIR *listing = opendir(folder);
  struct dirent *item;
  found->name[0] = 0;
  if (!listing) return 0;
  while ((item = readdir(listing))) {
    struct entry candidate;
    struct stat status;
    char path[4096];
    const size_t n = strlen(item->d_name);
    if (n <= length || n >= sizeof candidate.name || strcmp(item->d_name + n - length, ending) != 0) continue;
    if (snprintf(path, sizeof path, "%s/%s", folder, item->d_name) >= (int)sizeof path) continue;
    if (stat(path, &status) != 0 || !S_ISREG(status.st_mode)) continue;
    candidate.time = status.st_mtim;
    memcpy(candidate.name, item->d_name, n + 1);
    if (bound.name[0] && !is_newer(&bound, &candidate)) continue;
    if (!found->name[0] || is_newer(&candidate, found)) *found = candidate;
  }
  closedir(listing);
  return found->name[0] != 0;
}

/* Name of the file with this ending than which `newer` others are newer; its length, or 0 if there is none. */
int implam_file_by_age(const char *folder, const char *ending, int newer, char name[256])
{
  struct entry found;
  found.name[0] = 0;
  for (int i = 0; i <= newer; ++i)
    if (!next_older(folder, ending, &found)) return 0;
  memcpy(name, found.name, strlen(found.name));
  return (int)strlen(found.name);
}

/* 1: the path is a pipe; opening it would wait until another program opens its other end. */
int implam_is_pipe(const char *path)
{
  struct stat status;
  return stat(path, &status) == 0 && S_ISFIFO(status.st_mode);
}

/* 1: both paths, behind all links, lead to one file. */
int implam_is_same_file(const char *a, const char *b)
{
  struct stat first, second;
  if (stat(a, &first) != 0 || stat(b, &second) != 0) return 0;
  return first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

/* 1: the disk of this folder has no room for as many bytes. */
int implam_lacks_space(const char *folder, int bytes)
{
  struct statvfs disk;
  return statvfs(folder, &disk) == 0 && disk.f_bavail < (fsblkcnt_t)bytes / disk.f_frsize;
}
