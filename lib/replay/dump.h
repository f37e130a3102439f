/** Text of a trace: one line per call, one line per decision. */
#ifndef SLC_REPLAY_DUMP_H
#define SLC_REPLAY_DUMP_H

#include "core/observer.h"

#include <stdarg.h>

/** Printer of a trace. Disabled if `line` is NULL. */
struct slc_dump {
    void *user;
    void (*line)(void *user, const char *text);
    uint64_t event;      ///< number of the call, at the start of its lines
    bool indices_absent; ///< tile_indices is not valid
    char text[256];      ///< the current line
    size_t size;
};

/** Prints a whole line. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void slc_dump_line(struct slc_dump *dump, const char *format, ...);

/** Prints the inputs of a call, except feedback maps. */
void slc_dump_inputs(struct slc_dump *dump, const struct slc_call *call);

/** Prints an accepted map, then the outputs: result, list entries, MinMip texels. */
void slc_dump_decisions(struct slc_dump *dump, const SluiceStreamedTextureManager *manager,
                        const struct slc_call *call);

#endif /* SLC_REPLAY_DUMP_H */
