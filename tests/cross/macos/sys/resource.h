/* limits of a process */
#ifndef MACOS_STUB_SYS_RESOURCE_H
#define MACOS_STUB_SYS_RESOURCE_H

#include <stdint.h>

typedef uint64_t rlim_t;
struct rlimit {
    rlim_t rlim_cur, rlim_max;
};

#define RLIMIT_NOFILE 8
#define RLIM_INFINITY (((uint64_t)1 << 63) - 1)

int getrlimit(int resource, struct rlimit *limit);

#endif /* MACOS_STUB_SYS_RESOURCE_H */
