/* calls of POSIX. macOS has no fdatasync that is declared, no pipe2 and no dup3. */
#ifndef MACOS_STUB_UNISTD_H
#define MACOS_STUB_UNISTD_H

#include <sys/types.h>

#define STDERR_FILENO 2
#define W_OK 2
#define _SC_NPROCESSORS_ONLN 58

int close(int descriptor);
int faccessat(int folder, const char *path, int mode, int flags);
int fsync(int descriptor);
int ftruncate(int descriptor, off_t size);
pid_t getpid(void);
ssize_t pread(int descriptor, void *bytes, size_t size, off_t offset);
ssize_t pwrite(int descriptor, const void *bytes, size_t size, off_t offset);
ssize_t read(int descriptor, void *bytes, size_t size);
long sysconf(int name);
int unlink(const char *path);
int unlinkat(int folder, const char *path, int flags);
ssize_t write(int descriptor, const void *bytes, size_t size);

#endif /* MACOS_STUB_UNISTD_H */
