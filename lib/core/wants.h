/** Feedback maps to want counts. A merge is prepared, which may fail, and then committed. */
#ifndef SLC_CORE_WANTS_H
#define SLC_CORE_WANTS_H

#include "core/internal.h"

/** What a commit will need at most, added up over the textures of one call. */
struct slc_wants_need {
    uint64_t nodes, decays, changes;
};

/** Puts what the map asks for into the texture's next_asked. Changes nothing that can be seen. */
SluiceResult slc_wants_prepare(slc_manager *m, struct slc_texture *t,
                               const SluiceFeedbackDesc *feedback, struct slc_wants_need *need);

/** The same for a follower; `prepared` says that the primary's own map is in its next_asked. */
SluiceResult slc_wants_prepare_follower(slc_manager *m, const struct slc_texture *primary,
                                        bool prepared, struct slc_texture *follower,
                                        struct slc_wants_need *need);

/** Makes the per-tile and per-region memory if it is not there yet. */
SluiceResult slc_make_state(slc_manager *m, struct slc_texture *t);
/** Makes sure that `count` decays can be taken. */
bool slc_reserve_decays(slc_manager *m, uint64_t count);
/** Adds what merging next_asked can need. */
void slc_wants_add_need(const struct slc_texture *t, struct slc_wants_need *need);

/** Makes room for the commits. */
SluiceResult slc_wants_reserve(slc_manager *m, const struct slc_wants_need *need);

/** Merges next_asked. Cannot fail. */
void slc_wants_commit(slc_manager *m, struct slc_texture *t, uint64_t time, uint64_t timeout);

#endif /* SLC_CORE_WANTS_H */
