/** Snapshot of a page residency: the beginning of recordings of a residency in use. */
#ifndef SLC_DEMAND_PAGE_SNAPSHOT_H
#define SLC_DEMAND_PAGE_SNAPSHOT_H

#include "base/snapshot_io.h"
#include "demand/page_calls.h"

/** Writes the state. Changes nothing. Errors: io->result. */
void slc_residency_write_snapshot(const struct slc_demand_residency *residency,
                                  struct slc_snapshot_io *io);
/**
 * Reads a state into a new residency. Invalid states are refused. `memory`: memory of all classes
 * that have one; its functions are not called. After an error, io->result, the residency can only
 * be destroyed.
 */
void slc_residency_read_snapshot(struct slc_demand_residency *residency,
                                 const struct slc_page_memory *memory, struct slc_snapshot_io *io);
/** Gets the launches that were begun last and prepared last. */
void slc_residency_get_launches(const struct slc_demand_residency *residency, uint64_t *begun,
                                uint64_t *prepared);

#endif /* SLC_DEMAND_PAGE_SNAPSHOT_H */
