#include "read_sharing.h"

#include "../../tools/common/log.h"
#include "../../tools/common/text.h"

bool read_sharing_create(enum read_sharing sharing, uint32_t device_count, uint32_t thread_count,
                         SluiceReadPool **pool)
{
    const SluiceReadPoolCreateInfo info = {
        .structSize = sizeof info, .threadCount = thread_count, .log = {.pfnLog = log_say}};
    *pool = NULL;
    if (sharing == READ_SHARING_OFF || (sharing == READ_SHARING_AUTO && device_count < 2))
        return true;
    SluiceResult result = sluiceCreateReadPool(&info, pool);
    if (result != SLUICE_SUCCESS)
        text_say("there is no pool of reads: %s", sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

void read_sharing_print(SluiceReadPool *pool,
                        void (*print)(const char *name, const char *unit, double value, bool json),
                        bool json)
{
    SluiceReadPoolStatistics s = {.structSize = sizeof s};
    if (!pool || sluiceGetReadPoolStatistics(pool, &s) != SLUICE_SUCCESS)
        return;
    print("pool_reads", "regions", (double)s.readCount, json);
    print("pool_bytes_read", "B", (double)s.readSize, json);
    print("pool_joined", "regions", (double)s.joinedCount, json);
    print("pool_from_cache", "regions", (double)s.cachedCount, json);
    print("pool_evicted", "regions", (double)s.evictedCount, json);
    print("pool_kept_peak", "B", (double)s.keptPeakSize, json);
}
