/** Text of a demand-loading recording: a line per call, a line per list entry. */
#ifndef SLC_REPLAY_DEMAND_DUMP_H
#define SLC_REPLAY_DEMAND_DUMP_H

#include "demand/page_calls.h"
#include "replay/dump.h"

/** Prints a call with its outputs. */
void slc_dump_page_call(struct slc_dump *dump, const struct slc_page_call *call);

#endif /* SLC_REPLAY_DEMAND_DUMP_H */
