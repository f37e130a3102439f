#include "image/retry.h"

SluiceTileRetryPolicy slc_retry_policy(const SluiceTileRetryPolicy *given)
{
    SluiceTileRetryPolicy policy = *given;
    if (policy.maxAttempts == 0)
        policy.maxAttempts = 4;
    if (policy.firstDelayNs == 0)
        policy.firstDelayNs = 10000000;
    if (policy.maxDelayNs == 0)
        policy.maxDelayNs = 1000000000;
    return policy;
}

bool slc_retry_is_due(const SluiceTileRetryPolicy *policy, const struct slc_attempts *attempts,
                      SluiceResult result, uint64_t *delay)
{
    bool is_temporary = result == SLUICE_ERROR_IO || result == SLUICE_NOT_READY ||
                        result == SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    /* Damage is permanent, but data read while being written is complete the next time. */
    bool may_be_torn = result == SLUICE_ERROR_CORRUPT_DATA && attempts->corrupt_count == 1;
    if (attempts->count >= policy->maxAttempts || (!is_temporary && !may_be_torn))
        return false;
    *delay = policy->firstDelayNs;
    for (uint32_t i = 1; i < attempts->count && *delay < policy->maxDelayNs; i++)
        *delay = *delay > UINT64_MAX / 2 ? UINT64_MAX : *delay * 2;
    if (*delay > policy->maxDelayNs)
        *delay = policy->maxDelayNs;
    return true;
}
