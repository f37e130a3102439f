/** URLs for messages. */
#ifndef SLC_BASE_SHOWN_URL_H
#define SLC_BASE_SHOWN_URL_H

#include <sluice/base.h>

/**
 * A copy of a URL without user, password, query and fragment; of another path, a copy. NULL: no
 * memory. Free it with slc_free(cb, s, strlen(s) + 1, 1).
 */
char *slc_shown_url(const SluiceAllocationCallbacks *cb, const char *path);

#endif /* SLC_BASE_SHOWN_URL_H */
