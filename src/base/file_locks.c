/* Marks a file as being written by this process, for as long as the process lives: the kernel forgets the mark of a
   killed one. The constants that this takes are the system's own, so it is written in its language. */
#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* Descriptor that holds the lock; -1: there is none, as the file cannot be opened or locked or is a device, which may
   serve many; -2: another process holds it. Nothing is written, but a file that is not there is made. */
int implam_lock_file(const char *path)
{
  struct stat kind;
  const int descriptor = open(path, O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
  if (descriptor < 0) return -1;
  if (fstat(descriptor, &kind) == 0 && S_ISREG(kind.st_mode)) {
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
    if (errno == EWOULDBLOCK) {
      close(descriptor);
      return -2;
    }
  }
  close(descriptor);
  return -1;
}

/* Takes the mark away. */
void implam_unlock_file(int descriptor) { close(descriptor); }
