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

/** Sets the prefix of every message of this file, such as "sluice-info: ". Borrowed. Default:
 * "". */
void output_set_speaker(const char *speaker);

/**
 * Remembers an input, by device and inode, so that no output replaces it under any name. Ignores
 * missing and special files. Outputs that have begun are not checked again. Returns false, with a
 * message on stderr, when out of memory. Any thread.
 */
bool output_add_input(const char *path);
/** Returns whether `path` replaces no input. If it would, reports it on stderr. Any thread. */
bool output_spares_inputs(const char *path);

/**
 * Checks that a file can be written, replaces no input, and has a name of no other output of this
 * run. Call once per output, before the work that makes its contents. Leaves nothing behind.
 * Reports errors on stderr.
 */
bool output_can_write(const char *path);

/**
 * Keeps a name for a file that a library writes. Returns false, with a message on stderr, if the
 * name would replace an input or belongs to another output of the run. Any thread.
 */
bool output_claim(const char *path);

/**
 * Begins a file. Writes `path` with ".sluice-part" added, or `path` itself if it is a pipe or a
 * character device. Returns NULL, with a message on stderr, if that fails, would replace an input,
 * or the name was claimed. Any thread.
 */
struct output_file *output_file_begin(const char *path);
/** Begins a file that does not wait for the disk at its end, which takes tens of milliseconds.
 * After a power cut the file may be empty. For the many pictures of a run. */
struct output_file *output_file_begin_quickly(const char *path);
/** Returns the stream to write to, which belongs to the file. */
FILE *output_file_stream(struct output_file *file);
/**
 * Ends a file. Gives it its name if `keep` is set and all of it was written; otherwise removes it.
 * Returns whether it got its name. Reports write errors on stderr. NULL: returns false.
 */
bool output_file_end(struct output_file *file, bool keep);

/** Writes a whole file with printf. Reports errors on stderr and returns false. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
bool
output_file_print(const char *path, const char *format, ...);

#endif /* TOOLS_COMMON_OUTPUT_FILE_H */
