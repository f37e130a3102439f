/** REQUESTED tiles in the order in which they are loaded. */
#ifndef SLC_RESIDENCY_REQUEST_QUEUES_H
#define SLC_RESIDENCY_REQUEST_QUEUES_H

#include "residency/machine.h"

/** Adds or removes a request. Changes neither state nor counts by state. */
void slc_request_append(struct slc_machine *r, uint32_t node);
void slc_request_remove(struct slc_machine *r, uint32_t node);
/** Returns the REQUESTED tile to load first; 0 if there is none. */
uint32_t slc_first_request(const struct slc_machine *r);
/** Returns the REQUESTED tile after another one; 0 at the end. */
uint32_t slc_next_request(const struct slc_machine *r, uint32_t node);

#endif /* SLC_RESIDENCY_REQUEST_QUEUES_H */
