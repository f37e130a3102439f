/** Bakes many pictures in parallel on all processors, with one progress bar. */
#ifndef TOOLS_COMMON_BAKE_JOBS_H
#define TOOLS_COMMON_BAKE_JOBS_H

#include <sluice/bake.h>

/** A picture, its store, and the result of baking it. */
struct bake_job {
    const char *input, *output; ///< borrowed; missing folders are made
    const char *const *layers;  ///< pictures that become the store's layers; NULL: only `input`
    uint32_t layer_count;
    bool cube;     ///< true: the layers are faces of cube maps
    uint64_t size; ///< bytes of all inputs: the weight in the progress bar
    SluiceBakeSettings settings;
    bool force;
    bool is_done; ///< false: no thread could bake it
    SluiceResult result;
    SluiceBakeReport report;
    char message[512];   ///< first message, which names the picture; "": none
    char warnings[2048]; ///< lines, each with the picture's name; drops those that do not fit
};

/** Zeros are the defaults of the baker. */
struct bake_conditions {
    uint32_t threads;    ///< 0: one per processor
    uint64_t memory;     ///< bytes for all pictures that are being baked
    bool quiet;          ///< true: no progress, unless stderr is a terminal
    const char *speaker; ///< prefix of messages, such as "sluice-bake: "
};

/**
 * Bakes all pictures. The bar appears with the first picture that is not up to date. Messages that
 * name no picture go to stderr. Returns false, with a message on stderr, if no picture could be
 * begun.
 */
bool bake_jobs_run(struct bake_job *jobs, size_t count, const struct bake_conditions *conditions);

/** Prints the warnings of a baked picture on stderr. Prints none if it failed, because the error
 * tells why. */
void bake_job_say_warnings(const struct bake_job *job, const char *speaker);

#endif /* TOOLS_COMMON_BAKE_JOBS_H */
