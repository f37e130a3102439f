/** What the first word of the command line may be. */
#ifndef SLUICE_TRADEOFF_COMMANDS_H
#define SLUICE_TRADEOFF_COMMANDS_H

enum tradeoff_exit {
    TRADEOFF_DONE,
    TRADEOFF_FAILED,
    TRADEOFF_USAGE,
    TRADEOFF_NO_DEVICE = 77,
    TRADEOFF_INTERRUPTED = 130,
};

/** `argv[0]` is the tool's own path, the words behind it are the command's; exit statuses. */
int command_sweep(int argc, char **argv);
/** RESULTS [--json]: table, CSV files and page of what is there, without a run. */
int command_page(int argc, char **argv);

#endif /* SLUICE_TRADEOFF_COMMANDS_H */
