/** Retry policy of reads. */
#ifndef SLC_IMAGE_RETRY_H
#define SLC_IMAGE_RETRY_H

#include <sluice/loader.h>

/** Attempts at a read. */
struct slc_attempts {
    uint32_t count;         ///< attempts that have ended
    uint32_t corrupt_count; ///< attempts that ended with CORRUPT_DATA
};

/** Returns a policy with defaults in place of zeros. */
SluiceTileRetryPolicy slc_retry_policy(const SluiceTileRetryPolicy *given);

/** True if a read whose last attempt, counted already, ended with `result` is tried again after
 *  `*delay` ns. */
bool slc_retry_is_due(const SluiceTileRetryPolicy *policy, const struct slc_attempts *attempts,
                      SluiceResult result, uint64_t *delay);

#endif /* SLC_IMAGE_RETRY_H */
