/** Copies structures to the memory that they need: builds reserve for the worst. */
#ifndef DEMAND_PBRT_COMPACTION_H
#define DEMAND_PBRT_COMPACTION_H

#include "structures.h"

/** Replaces what was built by smaller copies. All builds have `compact`. Says on stderr why it
 *  failed; the structures are as they were then. */
bool structures_compact(const struct gpu *gpu, struct structures *structures,
                        const struct structure_build *builds, uint32_t count);

#endif /* DEMAND_PBRT_COMPACTION_H */
