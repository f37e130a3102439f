/** Facts about files: why the last file could not be opened, its unsupported features, and the
 *  report of sluice-info. */
#ifndef SLUICE_VIEW_FILE_FACTS_H
#define SLUICE_VIEW_FILE_FACTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct file_facts {
    char failed[512];       ///< file that could not be opened; "": the last one was opened
    uint32_t first_message; ///< first message (messages.h) about the last file
    char path[4096];        ///< path of the report; "": none
    char *report;           ///< owned; lines of report_file. NULL: no report
};

/** Frees the report. A zeroed struct is allowed. */
void file_facts_finish(struct file_facts *facts);
/** Notes that a file is going to be opened. Messages from now on belong to it. */
void file_facts_begin(struct file_facts *facts);
/** Notes whether the paths could be opened. Reads the report of a single file. Returns true if
 * there is a failure, a message or a report to show. */
bool file_facts_note(struct file_facts *facts, const char *const *paths, size_t count, bool opened);
/** Reads the report of a file: a tile store, a catalogue, an OpenEXR, DDS, KTX2 or .ntc file, or a
 *  picture in such a file ("set.ntc#name"). Other files have no report. */
void file_facts_look(struct file_facts *facts, const char *path);

#endif /* SLUICE_VIEW_FILE_FACTS_H */
