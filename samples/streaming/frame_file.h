/** Frames of one size in a file, one after another, RGBA bytes as they are. */
#ifndef SAMPLES_STREAMING_FRAME_FILE_H
#define SAMPLES_STREAMING_FRAME_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct frame_file {
    bool is_open;
    int descriptor;
    size_t frame_size;          ///< bytes
    struct output_file *output; ///< Owned. NULL but in a file that is being made.
};

/** Made anew; the file gets its name in frame_file_keep. Says on stderr why it failed. */
bool frame_file_create(const char *path, size_t frame_size, struct frame_file *file);
/** In a folder, without a name: gone when it is closed. Says on stderr why it failed. */
bool frame_file_create_scratch(const char *folder, size_t frame_size, struct frame_file *file);
/** To be read. False if it cannot be, or if it does not have the size of `count` frames. */
bool frame_file_open(const char *path, size_t frame_size, uint32_t count, struct frame_file *file);
/** Closes a file that was created and gives it its name. False, and nothing is left of it, if that
 *  failed; stderr says why. */
bool frame_file_keep(struct frame_file *file);
/** A file that is being made is removed. A zeroed struct is fine. */
void frame_file_close(struct frame_file *file);

/** Frames may be left out: they take no space. Says on stderr why it failed. Any thread. */
bool frame_file_write(const struct frame_file *file, uint32_t frame, const uint8_t *pixels);
/** Says on stderr why it failed. Any thread. */
bool frame_file_read(const struct frame_file *file, uint32_t frame, uint8_t *pixels);

#endif /* SAMPLES_STREAMING_FRAME_FILE_H */
