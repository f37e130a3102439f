/** The human form of a trace: one line per call, one line per decision. */
#ifndef SLC_REPLAY_DUMP_H
#define SLC_REPLAY_DUMP_H

#include "core/observer.h"

#include <stdarg.h>

/** Off while `line` is NULL. */
struct slc_dump {
    void *user;
    void (*line)(void *user, const char *text);
    uint64_t event;      ///< number of the call, in front of its lines
    bool indices_absent; ///< tile_indices points to something else
    char text[256];      ///< the line that is being built
    size_t size;
};

/** A whole line. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void slc_dump_line(struct slc_dump *dump, const char *format, ...);

/** What goes in, but for feedback maps. */
void slc_dump_inputs(struct slc_dump *dump, const struct slc_call *call);

/** A map that was taken, then what comes out: result, entries of lists, MinMip texels. */
void slc_dump_decisions(struct slc_dump *dump, const SluiceStreamedTextureManager *manager,
                        const struct slc_call *call);

#endif /* SLC_REPLAY_DUMP_H */
