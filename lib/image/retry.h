/** Which reads are tried again, and when. */
#ifndef SLC_IMAGE_RETRY_H
#define SLC_IMAGE_RETRY_H

#include <sluice/loader.h>

/** What has been tried of a read. */
struct slc_attempts {
    uint32_t count;         ///< that ended
    uint32_t corrupt_count; ///< those with CORRUPT_DATA
};

/** The defaults put in for zeros. */
SluiceTileRetryPolicy slc_retry_policy(const SluiceTileRetryPolicy *given);

/** Whether a read whose last attempt, counted already, ended with `result` is tried again after
 *  `*delay` ns. */
bool slc_retry_is_due(const SluiceTileRetryPolicy *policy, const struct slc_attempts *attempts,
                      SluiceResult result, uint64_t *delay);

#endif /* SLC_IMAGE_RETRY_H */
