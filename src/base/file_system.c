/* Age, kind and identity of files, and reasons of failed writes. They are in structures and numbers that each system
   lays out in its own way, so this is written in its language. */
#define _POSIX_C_SOURCE 200809L
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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

/* Writes blocks into a new file, from the place where the other one ends; returns the number of the error, or 0. */
static int extend(const char *trial, off_t place, int bytes)
{
  static const char zeros[65536];
  const int file = open(trial, O_WRONLY | O_CREAT | O_TRUNC, S_IRUSR | S_IWUSR);
  int error = file < 0 ? errno : 0;
  if (file < 0) return error;
  for (int done = 0; done < bytes && error == 0; done += (int)sizeof zeros)
    if (pwrite(file, zeros, sizeof zeros, place + done) < 0) error = errno;
  /* Network file systems may report a used up quota here only. */
  if (error == 0 && fsync(file) != 0) error = errno;
  if (close(file) != 0 && error == 0) error = errno;
  return error;
}

/* Why as many bytes more cannot be written to a file: 1 no space, 2 quota, 3 limit of the size of files, 4 another
   reason; 0: they can be. They are written to another file, which is removed. */
int implam_write_obstacle(const char *path, const char *trial, int bytes)
{
  struct stat status;
  const int error = extend(trial, stat(path, &status) == 0 ? status.st_size : 0, bytes);
  unlink(trial);
  switch (error) {
  case 0: return 0;
  case ENOSPC: return 1;
  case EDQUOT: return 2;
  case EFBIG: return 3;
  default: return 4;
  }
}

/* The reason of the last failure in words that end a sentence, without a final zero; returns their number. */
int implam_last_reason(char *text, int size)
{
  const char *words = errno ? strerror(errno) : "the system gives no reason";
  int length = (int)strlen(words);
  if (length > size) length = size;
  memcpy(text, words, (size_t)length);
  /* "No such file", but not the first letters of an abbreviation. */
  if (length > 1 && islower((unsigned char)text[1])) text[0] = (char)tolower((unsigned char)text[0]);
  return length;
}

/* A write beyond the limit of the size of files then fails, as on a full disk, and does not end the program. */
void implam_ignore_size_signal(void) { signal(SIGXFSZ, SIG_IGN); }
