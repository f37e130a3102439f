/** Bakes all files on all processors. */
#ifndef TOOLS_SLUICE_BAKE_RUN_H
#define TOOLS_SLUICE_BAKE_RUN_H

#include "files.h"
#include "options.h"

/** What became of a file. */
struct outcome {
    bool is_done; ///< there was a thread for it
    SluiceResult result;
    SluiceBakeReport report;
    char message[512]; ///< the first thing that was said of it; "": nothing
};

/** Fills outcomes[files->count]. False, having said why, if nothing could be begun. */
bool bake_files(const struct options *options, const struct files *files, struct outcome *outcomes);

#endif /* TOOLS_SLUICE_BAKE_RUN_H */
