/* stat. Times have other names than in POSIX. */
#ifndef MACOS_STUB_SYS_STAT_H
#define MACOS_STUB_SYS_STAT_H

#include <sys/types.h>

struct stat {
    dev_t st_dev;
    mode_t st_mode;
    nlink_t st_nlink;
    ino_t st_ino;
    struct timespec st_atimespec, st_mtimespec, st_ctimespec;
    off_t st_size;
};

#define S_ISCHR(mode) (((mode)&0170000) == 0020000)
#define S_ISDIR(mode) (((mode)&0170000) == 0040000)
#define S_ISFIFO(mode) (((mode)&0170000) == 0010000)
#define S_ISLNK(mode) (((mode)&0170000) == 0120000)
#define S_ISREG(mode) (((mode)&0170000) == 0100000)
#define S_IWOTH 0000002
#define UTIME_NOW -1
#define UTIME_OMIT -2

int fchmod(int descriptor, mode_t mode);
int fstat(int descriptor, struct stat *status);
int fstatat(int folder, const char *path, struct stat *status, int flags);
int lstat(const char *path, struct stat *status);
int mkdir(const char *path, mode_t mode);
int stat(const char *path, struct stat *status);
int utimensat(int folder, const char *path, const struct timespec times[2], int flags);

#endif /* MACOS_STUB_SYS_STAT_H */
