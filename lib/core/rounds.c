#include "core/rounds.h"

#include "base/checked.h"

enum { LONG_WAIT = 4 };

void slc_end_round(struct slc_round *r, uint32_t visited_count, uint64_t next_sequence)
{
    if (r->maps < slc_max_u32(visited_count, 1))
        return;
    r->maps = 0;
    r->waited = r->began;
    r->began = next_sequence;
    if (++r->count % LONG_WAIT == 0) {
        r->waited_long = r->began_long;
        r->began_long = r->began;
    }
}
