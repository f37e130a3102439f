#include "base/shown_url.h"

#include "base/alloc.h"

#include <string.h>

char *slc_shown_url(const SluiceAllocationCallbacks *cb, const char *path)
{
    const char *scheme = strstr(path, "://");
    if (!scheme)
        return slc_strdup(cb, path);
    const char *host = scheme + 3, *end = host + strcspn(host, "?#");
    const char *slash = host + strcspn(host, "/?#");
    for (const char *at = host; at < slash; at++)
        if (*at == '@')
            host = at + 1;
    size_t front = (size_t)(scheme + 3 - path), back = (size_t)(end - host);
    size_t size = front + back + 1;
    char *shown = slc_alloc(cb, size, 1);
    if (shown) {
        memcpy(shown, path, front);
        memcpy(shown + front, host, back);
        shown[front + back] = '\0';
    }
    return shown;
}
