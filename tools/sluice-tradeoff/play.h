/** The subcommand `play`: plays a feedback trace with given settings, and prints their cost. --help
 * lists the settings. */
#ifndef SLUICE_TRADEOFF_PLAY_H
#define SLUICE_TRADEOFF_PLAY_H

#include <stdio.h>

/** Runs the subcommand. argv[0] is its name. Returns the exit status: 0; 1 for an unplayable trace
 * or a file that cannot be written; 2 for wrong usage. */
int play_main(int argc, char **argv);

/** Runs the subcommand, and prints the figures to `out`. */
int play_print(int argc, char **argv, FILE *out);

#endif /* SLUICE_TRADEOFF_PLAY_H */
