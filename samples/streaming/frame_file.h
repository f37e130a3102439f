/** Frames of one size in a file, one after another, as RGBA bytes. */
#ifndef SAMPLES_STREAMING_FRAME_FILE_H
#define SAMPLES_STREAMING_FRAME_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct frame_file {
    bool is_open;
    int descriptor;
    size_t frame_size;          ///< bytes
    struct output_file *output; ///< owned; NULL except while a file is being created
};

/** Creates a file, which gets its name in frame_file_keep. Reports errors on stderr. */
bool frame_file_create(const char *path, size_t frame_size, struct frame_file *file);
/** Creates a file without a name in a folder. Closing deletes it. Reports errors on stderr. */
bool frame_file_create_scratch(const char *folder, size_t frame_size, struct frame_file *file);
/** Opens a file for reading. Returns false if that fails, or if its size is not that of `count`
 * frames. */
bool frame_file_open(const char *path, size_t frame_size, uint32_t count, struct frame_file *file);
/** Closes a created file and gives it its name. On error removes the file, reports on stderr and
 * returns false. */
bool frame_file_keep(struct frame_file *file);
/** Closes a file. Removes it if it was created and not kept. A zeroed struct is allowed. */
void frame_file_close(struct frame_file *file);

/** Writes a frame. Frames that are never written occupy no disk space. Reports errors on stderr.
 * Any thread. */
bool frame_file_write(const struct frame_file *file, uint32_t frame, const uint8_t *pixels);
/** Reads a frame. Reports errors on stderr. Any thread. */
bool frame_file_read(const struct frame_file *file, uint32_t frame, uint8_t *pixels);

#endif /* SAMPLES_STREAMING_FRAME_FILE_H */
