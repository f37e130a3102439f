/** Tiles that were given up are tried again. */
#ifndef SLC_CORE_GIVEN_UP_RETRY_H
#define SLC_CORE_GIVEN_UP_RETRY_H

#include "core/state.h"

/** A tile of the texture failed and was given up. */
void slc_given_up_again(slc_manager *m, struct slc_managed_texture *t);
/** A tile of the texture was loaded, after failures or without. */
void slc_given_up_note_success(slc_manager *m, struct slc_managed_texture *t, bool had_failed);
/** Requests tiles whose retry is due. Call it after the time changed, if m->trouble_count > 0. */
void slc_given_up_advance(slc_manager *m);
/** Puts the texture at the end of another list. */
void slc_trouble_move(slc_manager *m, struct slc_managed_texture *t, enum slc_trouble to);

#endif /* SLC_CORE_GIVEN_UP_RETRY_H */
