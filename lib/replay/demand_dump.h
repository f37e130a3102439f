/** The human form of a recording of demand loading: a line per call, a line per entry of lists. */
#ifndef SLC_REPLAY_DEMAND_DUMP_H
#define SLC_REPLAY_DEMAND_DUMP_H

#include "demand/page_calls.h"
#include "replay/dump.h"

/** A call that was made, with what came out. */
void slc_dump_page_call(struct slc_dump *dump, const struct slc_page_call *call);

#endif /* SLC_REPLAY_DEMAND_DUMP_H */
