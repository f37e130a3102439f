/** Prints the result of a replay. */
#ifndef TOOLS_SLUICE_REPLAY_REPORT_H
#define TOOLS_SLUICE_REPLAY_REPORT_H

#include <sluice/replay.h>

/** Prints statistics in columns, and the hash line of the dump. */
void print_report(const SluiceReplayResult *result,
                  const SluiceStreamedTextureStatistics *statistics);

/** Prints statistics and hash as JSON: one object per line with name, value and unit. */
void print_json(const SluiceReplayResult *result,
                const SluiceStreamedTextureStatistics *statistics);

#endif /* TOOLS_SLUICE_REPLAY_REPORT_H */
