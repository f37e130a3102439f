/** Reports of GIVEN_UP tiles that sluiceGetGivenUpTiles has not listed yet. */
#ifndef SLC_CORE_REPORTS_H
#define SLC_CORE_REPORTS_H

#include "core/state.h"

uint32_t slc_reports_count(const slc_manager *m);
/** Reserves memory for `count` more reports. False: there is no memory. */
bool slc_reports_reserve(slc_manager *m, uint32_t count);
/** Adds a report. Does nothing if the tile has one. */
void slc_reports_add(slc_manager *m, struct slc_managed_texture *t, uint32_t tile);
/** Removes the oldest reports and writes their tiles. Returns how many. */
uint32_t slc_reports_take(slc_manager *m, uint32_t room, SluiceTile *tiles);
/** Drops the reports of a texture that is removed. */
void slc_reports_drop(slc_manager *m, struct slc_managed_texture *t);
/** Returns NULL, or the broken invariant. */
const char *slc_reports_check(const slc_manager *m);

#endif /* SLC_CORE_REPORTS_H */
