/** Reports of texture files, which sluice-info prints and sluice-view shows. */
#ifndef TOOLS_SLUICE_INFO_FILE_REPORT_H
#define TOOLS_SLUICE_INFO_FILE_REPORT_H

#include <stdbool.h>
#include <stdio.h>

/** Writes the report of a tile store, a catalogue, an OpenEXR, DDS, KTX2 or .ntc file to `out`.
 * `json`: one line of JSON; otherwise lines "  name   value" below the path. Reports on stderr why
 * a file cannot be read, and returns false. */
bool report_file(const char *path, bool json, FILE *out);

/** Returns whether report_file can report on the file, judging by its first bytes. False for
 * URLs. */
bool report_takes(const char *path);

/** Parts of report_file. */
bool report_texture_file(const char *path, bool json, FILE *out);
bool report_neural_file(const char *path, bool json, FILE *out);
bool report_catalogue(const char *path, bool json, FILE *out);
/** Returns whether the first bytes are those of a tile store, an OpenEXR, DDS or KTX2 file. */
bool is_texture_file(const char *path);
/** Returns whether the file is a catalogue. False for unreadable files and for URLs. */
bool is_catalogue(const char *path);
/** Returns whether the first bytes are those of a .ntc file. False for unreadable files. */
bool is_neural_file(const char *path);

#endif /* TOOLS_SLUICE_INFO_FILE_REPORT_H */
