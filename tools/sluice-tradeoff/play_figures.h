/** Prints the figures of a played trace, and writes a table of its frames. */
#ifndef SLUICE_TRADEOFF_PLAY_FIGURES_H
#define SLUICE_TRADEOFF_PLAY_FIGURES_H

#include "play_loop.h"

#include <stdio.h>

struct play_printer {
    FILE *out;
    bool json; ///< true: a JSON object per figure
};

/** Prints a line. A value that is not finite is left out, or null in JSON. */
void play_print_figure(const struct play_printer *printer, const char *name, double value,
                       const char *unit);

/** Call after play_loop_run. Returns false when out of memory, with a message on stderr. */
bool play_print_figures(const struct play_printer *printer, const struct play_loop *loop);

/** Writes frames.csv to a folder, and creates the folder if necessary. Reports errors on stderr. */
bool play_write_frames(const struct play_loop *loop, const char *folder);

#endif /* SLUICE_TRADEOFF_PLAY_FIGURES_H */
