/** Retries of GIVEN_UP tiles. */
#ifndef SLC_CORE_GIVEN_UP_RETRY_H
#define SLC_CORE_GIVEN_UP_RETRY_H

#include "core/state.h"

/** Notes that a tile of the texture failed and became GIVEN_UP. */
void slc_given_up_again(slc_manager *m, struct slc_managed_texture *t);
/** Notes that a tile of the texture was loaded. `had_failed`: after failures. */
void slc_given_up_note_success(slc_manager *m, struct slc_managed_texture *t, bool had_failed);
/** Requests tiles whose retry is due. Call it after the time changed, if m->trouble_count > 0. */
void slc_given_up_advance(slc_manager *m);
/** Moves the texture to the end of the list `to`. */
void slc_trouble_move(slc_manager *m, struct slc_managed_texture *t, enum slc_trouble to);

#endif /* SLC_CORE_GIVEN_UP_RETRY_H */
