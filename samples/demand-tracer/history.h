/** Records of all launches: the rows of frames.csv. */
#ifndef TRACER_HISTORY_H
#define TRACER_HISTORY_H

#include "launches.h"

struct history_row {
    struct launch_record launch;
    uint32_t device;
    uint64_t resident_tiles, loaded_tiles, bytes_read, bytes_uploaded; ///< so far
    double seconds; ///< since the first launch began
};

/** Zeroed is empty. */
struct history {
    struct history_row *rows; ///< owned
    size_t count, room;
    uint64_t resident_peak; ///< tiles
};

/** Reports on stderr when out of memory. */
bool history_add(struct history *history, const struct history_row *row);
void history_finish(struct history *history);

/** Writes FOLDER/frames.csv, one history after the other. Reports errors on stderr. */
bool history_write(const struct history *const *histories, uint32_t count, const char *folder);

#endif /* TRACER_HISTORY_H */
