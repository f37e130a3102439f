/** Tiles that were given up and not asked for yet. */
#ifndef SLC_CORE_REPORTS_H
#define SLC_CORE_REPORTS_H

#include "core/state.h"

uint32_t slc_reports_count(const slc_manager *m);
/** Room for `count` more. False: there is no memory. */
bool slc_reports_reserve(slc_manager *m, uint32_t count);
/** Nothing happens if it is there. */
void slc_reports_add(slc_manager *m, struct slc_managed_texture *t, uint32_t tile);
/** Hands out the oldest ones. Returns how many. */
uint32_t slc_reports_take(slc_manager *m, uint32_t room, SluiceTile *tiles);
/** The texture is removed. */
void slc_reports_drop(slc_manager *m, struct slc_managed_texture *t);
/** NULL, or what is wrong. */
const char *slc_reports_check(const slc_manager *m);

#endif /* SLC_CORE_REPORTS_H */
