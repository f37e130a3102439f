/** Reports of texture files, which sluice-info prints and sluice-view shows. */
#ifndef TOOLS_SLUICE_INFO_FILE_REPORT_H
#define TOOLS_SLUICE_INFO_FILE_REPORT_H

#include <stdbool.h>
#include <stdio.h>

/** Writes the report of a tile store, a catalogue, an OpenEXR, DDS, KTX2 or .ntc file to `out`: a
 *  line of JSON, or lines "  name   value" below the path. False, and says on stderr why, if the
 *  file cannot be read. */
bool report_file(const char *path, bool json, FILE *out);

/** Whether report_file knows the kind of the file, by its first bytes. False for URLs. */
bool report_takes(const char *path);

/** Parts of report_file. */
bool report_texture_file(const char *path, bool json, FILE *out);
bool report_neural_file(const char *path, bool json, FILE *out);
bool report_catalogue(const char *path, bool json, FILE *out);
/** Whether a file begins as a tile store, an OpenEXR, DDS or KTX2 file does. */
bool is_texture_file(const char *path);
/** False also for a file that cannot be read, and for URLs. */
bool is_catalogue(const char *path);
/** Whether the file begins as one of neural textures does. False also if it cannot be read. */
bool is_neural_file(const char *path);

#endif /* TOOLS_SLUICE_INFO_FILE_REPORT_H */
