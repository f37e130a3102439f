#include "cache.h"

#include <stdio.h>
#include <stdlib.h>

bool cache_path(const char *cache, const char *name, char *path, size_t size)
{
    const char *xdg = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    int length;
    if (cache)
        length = snprintf(path, size, "%s/%s", cache, name);
    else if (xdg && *xdg)
        length = snprintf(path, size, "%s/sluice/%s", xdg, name);
    else
        length = snprintf(path, size, "%s/.cache/sluice/%s", home ? home : ".", name);
    return length > 0 && (size_t)length < size;
}
