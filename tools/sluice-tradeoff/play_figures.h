/** What is said of a trace that was played: a line for each figure, and a table of its frames. */
#ifndef SLUICE_TRADEOFF_PLAY_FIGURES_H
#define SLUICE_TRADEOFF_PLAY_FIGURES_H

#include "play_loop.h"

#include <stdio.h>

struct play_printer {
    FILE *out;
    bool json; ///< an object for each figure
};

/** A line; a value that is not finite is left out, or null. */
void play_print_figure(const struct play_printer *printer, const char *name, double value,
                       const char *unit);

/** After play_loop_run. False, with a message, if memory is short. */
bool play_print_figures(const struct play_printer *printer, const struct play_loop *loop);

/** frames.csv in a folder that is made if it is not there. Says on stderr why it failed. */
bool play_write_frames(const struct play_loop *loop, const char *folder);

#endif /* SLUICE_TRADEOFF_PLAY_FIGURES_H */
