/**
 * Files that programs write. A file appears under its name when it is complete; after a failure
 * what was there stays. See docs/decisions/0034-one-way-to-write-a-file.md for what is refused.
 *
 * A program names each input with output_add_input. From then on no output replaces the input.
 * A name that was asked for with output_can_write or output_claim belongs to one output of the run.
 */
#ifndef TOOLS_COMMON_OUTPUT_FILE_H
#define TOOLS_COMMON_OUTPUT_FILE_H

#include <stdbool.h>
#include <stdio.h>

struct output_file;

/** Text in front of every message of this file, as "sluice-info: ". Borrowed. Default: "". */
void output_set_speaker(const char *speaker);

/**
 * Remembers a file that is read, by device and inode, so that no name of it is written. Files that
 * do not exist and what is no regular file are passed over. False when out of memory, which stderr
 * says. Outputs that have begun are not checked again. Any thread.
 */
bool output_add_input(const char *path);
/** False, which stderr says, if writing `path` would replace an input. Any thread. */
bool output_spares_inputs(const char *path);

/**
 * Tells whether a file can be written, replaces no input, and has a name that no other output of
 * this run has: to be asked once, before the work whose result is written there. Leaves nothing
 * behind. Says on stderr why not.
 */
bool output_can_write(const char *path);

/**
 * Keeps a name for a file that a library writes. False, which stderr says, if it would replace an
 * input or if another output of this run has the name. Any thread.
 */
bool output_claim(const char *path);

/**
 * Begins a file. `path` with ".sluice-part" added is written, or `path` itself if it is a pipe or a
 * character device. NULL if that fails, would replace an input, or has a name that
 * was claimed; stderr says why. Any thread.
 */
struct output_file *output_file_begin(const char *path);
/** Begins a file without waiting for the disk at its end, which takes tens of milliseconds: after a
 *  power cut it may be empty. For the many pictures of a run. */
struct output_file *output_file_begin_quickly(const char *path);
/** To write to; belongs to the file. */
FILE *output_file_stream(struct output_file *file);
/**
 * Ends a file: gives it its name if `keep` and all of it could be written, removes it otherwise.
 * False if not all of it could be written, which stderr says, or not `keep`. NULL: false.
 */
bool output_file_end(struct output_file *file, bool keep);

/** Writes a whole file: a text that printf makes. False if it failed, and stderr says why. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
bool
output_file_print(const char *path, const char *format, ...);

#endif /* TOOLS_COMMON_OUTPUT_FILE_H */
