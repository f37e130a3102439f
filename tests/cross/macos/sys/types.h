/* types of POSIX, as wide as on macOS */
#ifndef MACOS_STUB_SYS_TYPES_H
#define MACOS_STUB_SYS_TYPES_H

#include <stddef.h>
#include <stdint.h>

typedef long ssize_t;
typedef int64_t off_t;
typedef uint16_t mode_t;
typedef uint16_t nlink_t;
typedef int32_t dev_t;
typedef uint64_t ino_t;
typedef uint32_t uid_t;
typedef int32_t pid_t;
typedef long time_t;

struct timespec {
    time_t tv_sec;
    long tv_nsec;
};

#endif /* MACOS_STUB_SYS_TYPES_H */
