/** Commands: the first word of the command line. */
#ifndef SLUICE_TRADEOFF_COMMANDS_H
#define SLUICE_TRADEOFF_COMMANDS_H

enum tradeoff_exit {
    TRADEOFF_DONE,
    TRADEOFF_FAILED,
    TRADEOFF_USAGE,
    TRADEOFF_NO_DEVICE = 77,
    TRADEOFF_INTERRUPTED = 130,
};

/** Runs a command. `argv[0]` is the tool's own path; the command's words follow. Returns the exit
 * status. */
int command_sweep(int argc, char **argv);
/** RESULTS [--json]: writes table, CSV files and page of existing results, without a run. */
int command_page(int argc, char **argv);

#endif /* SLUICE_TRADEOFF_COMMANDS_H */
