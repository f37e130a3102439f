/** Is my file good? Why the last file could not be opened, what of it is not supported, and the
 *  report that sluice-info has of a file. */
#ifndef SLUICE_VIEW_FILE_FACTS_H
#define SLUICE_VIEW_FILE_FACTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct file_facts {
    char failed[512];       ///< what could not be opened last; "": the last one was opened
    uint32_t first_message; ///< of messages.h; what was said since the last file was opened
    char path[4096];        ///< of the report; "": none
    char *report;           ///< owned; lines of report_file. NULL: the file has none
};

/** A zeroed struct is fine. */
void file_facts_finish(struct file_facts *facts);
/** Something is going to be opened: what is said from now on belongs to it. */
void file_facts_begin(struct file_facts *facts);
/** It was opened, or not. Returns whether there is something to show about it: a failure, messages,
 *  or a report, of a single picture. */
bool file_facts_note(struct file_facts *facts, const char *const *paths, size_t count, bool opened);
/** Reads the report of a file: a tile store, a catalogue, an OpenEXR, DDS, KTX2 or .ntc file, or
 *  a picture inside of one ("set.ntc#name"). Others have none. */
void file_facts_look(struct file_facts *facts, const char *path);

#endif /* SLUICE_VIEW_FILE_FACTS_H */
