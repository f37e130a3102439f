#define _POSIX_C_SOURCE 200809L
#include "descriptors.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

void descriptors_raise(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == limit.rlim_max)
        return;
    limit.rlim_cur = limit.rlim_max;
    (void)setrlimit(RLIMIT_NOFILE, &limit);
}

static unsigned quarter_of_limit(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur / 4 > DESCRIPTORS_KEPT_MAX)
        return DESCRIPTORS_KEPT_MAX;
    return (unsigned)(limit.rlim_cur / 4);
}

void descriptors_keep(struct descriptors_kept *kept, unsigned count)
{
    unsigned most = quarter_of_limit();
    kept->count = 0;
    while (kept->count < count && kept->count < most) {
        int number = open("/dev/null", O_RDONLY | O_CLOEXEC);
        if (number < 0)
            break;
        kept->numbers[kept->count++] = number;
    }
}

void descriptors_release(struct descriptors_kept *kept)
{
    while (kept->count > 0)
        close(kept->numbers[--kept->count]);
}
