// A folder on a file system that lacks something, for a program that is started with this library in
// LD_PRELOAD. DISPERSA_TEST_FOLDER is the folder. DISPERSA_TEST_LACKS says what is missing there:
// "folder_sync", "sync", "locks" (fcntl), "flock", "mapping". DISPERSA_TEST_ERRNO is the errno of the refused
// call.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static int Lacks(const char* what, int file) {
  const char* lacks = getenv("DISPERSA_TEST_LACKS");
  const char* folder = getenv("DISPERSA_TEST_FOLDER");
  char link[64], path[4096];
  if (lacks == NULL || folder == NULL || strcmp(lacks, what) != 0) return 0;
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t size = readlink(link, path, sizeof path - 1);
  if (size < 0) return 0;
  path[size] = '\0';
  if (strncmp(path, folder, strlen(folder)) != 0) return 0;
  errno = atoi(getenv("DISPERSA_TEST_ERRNO"));
  return 1;
}

static int LacksSync(int file) {
  struct stat what;
  if (Lacks("sync", file)) return 1;
  return fstat(file, &what) == 0 && S_ISDIR(what.st_mode) && Lacks("folder_sync", file);
}

static int LacksLocks(int file, int command) {
  return (command == F_SETLK || command == F_SETLKW || command == F_GETLK) && Lacks("locks", file);
}

int fsync(int file) { return LacksSync(file) ? -1 : NEXT(fsync)(file); }
int fdatasync(int file) { return LacksSync(file) ? -1 : NEXT(fdatasync)(file); }

int flock(int file, int operation) {
  return operation != LOCK_UN && Lacks("flock", file) ? -1 : NEXT(flock)(file, operation);
}

int fcntl(int file, int command, ...) {
  va_list rest;
  va_start(rest, command);
  void* argument = va_arg(rest, void*);
  va_end(rest);
  return LacksLocks(file, command) ? -1 : NEXT(fcntl)(file, command, argument);
}

int fcntl64(int file, int command, ...) {
  va_list rest;
  va_start(rest, command);
  void* argument = va_arg(rest, void*);
  va_end(rest);
  return LacksLocks(file, command) ? -1 : NEXT(fcntl64)(file, command, argument);
}

void* mmap(void* at, size_t size, int protection, int flags, int file, off_t offset) {
  if (file >= 0 && (flags & MAP_SHARED) && Lacks("mapping", file)) return MAP_FAILED;
  return NEXT(mmap)(at, size, protection, flags, file, offset);
}

void* mmap64(void* at, size_t size, int protection, int flags, int file, off64_t offset) {
  if (file >= 0 && (flags & MAP_SHARED) && Lacks("mapping", file)) return MAP_FAILED;
  return NEXT(mmap64)(at, size, protection, flags, file, offset);
}
