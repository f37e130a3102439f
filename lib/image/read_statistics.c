#include "image/read_statistics.h"

static uint32_t bucket_of(uint64_t latency)
{
    uint32_t bucket = 0;
    while (latency > 1 && bucket < SLC_LATENCY_BUCKETS - 1) {
        latency >>= 1;
        bucket++;
    }
    return bucket;
}

void slc_read_statistics_add_attempt(struct slc_read_statistics *statistics, SluiceResult result,
                                     uint64_t offset, uint64_t latency)
{
    SluiceTileLoaderStatistics *counts = &statistics->counts;
    counts->attemptCount++;
    if (result == SLUICE_NOT_READY) {
        counts->notReadyCount++;
    } else if (result != SLUICE_SUCCESS && result != SLUICE_ERROR_CANCELED) {
        counts->failedCount++;
        counts->lastFailure = result;
        counts->lastFailureOffset = offset;
    }
    if (latency > counts->maxLatencyNs)
        counts->maxLatencyNs = latency;
    uint64_t room = UINT64_MAX - statistics->latency_sum;
    statistics->latency_sum += latency < room ? latency : room;
    statistics->latencies[bucket_of(latency)]++;
}

void slc_read_statistics_add_end(struct slc_read_statistics *statistics, SluiceResult result,
                                 uint64_t size)
{
    SluiceTileLoaderStatistics *counts = &statistics->counts;
    if (result == SLUICE_ERROR_CANCELED) {
        counts->canceledCount++;
    } else if (result != SLUICE_SUCCESS) {
        counts->givenUpCount++;
    } else {
        counts->succeededCount++;
        counts->byteCount += size;
    }
}

/* Returns the lowest bucket edge below which at least `percent` of all attempts are. */
static uint64_t percentile(const struct slc_read_statistics *statistics, uint32_t percent)
{
    uint64_t all = statistics->counts.attemptCount, below = 0;
    uint64_t wanted = all / 100 * percent + (all % 100 * percent + 99) / 100;
    for (uint32_t i = 0; i < SLC_LATENCY_BUCKETS - 1; i++) {
        below += statistics->latencies[i];
        uint64_t edge = ((uint64_t)2 << i) - 1;
        if (below >= wanted)
            return edge < statistics->counts.maxLatencyNs ? edge : statistics->counts.maxLatencyNs;
    }
    return statistics->counts.maxLatencyNs;
}

void slc_read_statistics_write(const struct slc_read_statistics *statistics,
                               SluiceTileLoaderStatistics *out)
{
    *out = statistics->counts;
    if (out->attemptCount == 0)
        return;
    out->meanLatencyNs = statistics->latency_sum / out->attemptCount;
    out->medianLatencyNs = percentile(statistics, 50);
    out->latency99Ns = percentile(statistics, 99);
}
