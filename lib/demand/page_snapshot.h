/** A recording that begins while demand loading is in use begins with its state. */
#ifndef SLC_DEMAND_PAGE_SNAPSHOT_H
#define SLC_DEMAND_PAGE_SNAPSHOT_H

#include "base/snapshot_io.h"
#include "demand/page_calls.h"

/** Writes the state. Changes nothing. Errors: io->result. */
void slc_residency_write_snapshot(const struct slc_demand_residency *residency,
                                  struct slc_snapshot_io *io);
/**
 * Gives a new residency a state, which may be any: what none can have is refused. `memory` is that
 * of all classes that have one; it is not asked. After an error, io->result, the residency can only
 * be destroyed.
 */
void slc_residency_read_snapshot(struct slc_demand_residency *residency,
                                 const struct slc_page_memory *memory, struct slc_snapshot_io *io);
/** Writes the launch that was begun last and the one that was prepared last. */
void slc_residency_get_launches(const struct slc_demand_residency *residency, uint64_t *begun,
                                uint64_t *prepared);

#endif /* SLC_DEMAND_PAGE_SNAPSHOT_H */
