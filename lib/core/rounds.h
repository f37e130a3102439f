/** Waiting time of requests, in rounds of maps of all textures. */
#ifndef SLC_CORE_ROUNDS_H
#define SLC_CORE_ROUNDS_H

#include "core/state.h"

/** Ends the round if as many maps have come as there are textures with requests. */
void slc_end_round(struct slc_round *r, uint32_t visited_count, uint64_t next_sequence);

#endif /* SLC_CORE_ROUNDS_H */
