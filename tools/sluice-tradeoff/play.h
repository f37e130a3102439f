/** "A recorded trace alone": plays a feedback trace with the settings that it is given, and prints
 *  what they cost. --help says which there are. */
#ifndef SLUICE_TRADEOFF_PLAY_H
#define SLUICE_TRADEOFF_PLAY_H

#include <stdio.h>

/** The subcommand: argv[0] is its name. Returns the exit status: 0; 1 for a trace that cannot be
 *  played or a file that cannot be written; 2 for wrong usage. */
int play_main(int argc, char **argv);

/** The same, with the figures elsewhere. */
int play_print(int argc, char **argv, FILE *out);

#endif /* SLUICE_TRADEOFF_PLAY_H */
