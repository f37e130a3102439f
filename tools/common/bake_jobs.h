/** Many pictures baked side by side on all processors, with one progress bar. */
#ifndef TOOLS_COMMON_BAKE_JOBS_H
#define TOOLS_COMMON_BAKE_JOBS_H

#include <sluice/bake.h>

/** A picture, where its store goes, and then what became of it. */
struct bake_job {
    const char *input, *output; ///< borrowed; folders are made
    const char *const *layers;  ///< pictures that become its layers; NULL: `input` alone
    uint32_t layer_count;
    bool cube;     ///< the layers are faces of cube maps
    uint64_t size; ///< bytes of all inputs, its share of the progress bar
    SluiceBakeSettings settings;
    bool force;
    bool is_done; ///< there was a thread for it
    SluiceResult result;
    SluiceBakeReport report;
    char message[512];   ///< the first thing that was said of it, which names it; "": nothing
    char warnings[2048]; ///< lines, each of which names it; those that do not fit are left out
};

/** Zeros are the baker's defaults. */
struct bake_conditions {
    uint32_t threads;    ///< 0: one per processor
    uint64_t memory;     ///< bytes for all pictures under way
    bool quiet;          ///< no progress where stderr is no terminal
    const char *speaker; ///< stands in front of messages; "sluice-bake: " and the like
};

/**
 * Bakes all. The bar appears with the first picture that is not up to date. What is said of none of
 * the pictures goes to stderr. False, having said why, if nothing could be begun.
 */
bool bake_jobs_run(struct bake_job *jobs, size_t count, const struct bake_conditions *conditions);

/** The warnings of a picture that was baked all the same, on stderr; of others the error says why.
 */
void bake_job_say_warnings(const struct bake_job *job, const char *speaker);

#endif /* TOOLS_COMMON_BAKE_JOBS_H */
