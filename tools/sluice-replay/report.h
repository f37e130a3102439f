/** What a replay amounted to. */
#ifndef TOOLS_SLUICE_REPLAY_REPORT_H
#define TOOLS_SLUICE_REPLAY_REPORT_H

#include <sluice/replay.h>

/** Statistics in columns, and the hash line of the dump. */
void print_report(const SluiceReplayResult *result,
                  const SluiceStreamedTextureStatistics *statistics);

/** The same, one object per line with name, value and unit. */
void print_json(const SluiceReplayResult *result,
                const SluiceStreamedTextureStatistics *statistics);

#endif /* TOOLS_SLUICE_REPLAY_REPORT_H */
