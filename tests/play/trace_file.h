/** Writes SLTRACE1 traces by their description in docs/replay.md. */
#ifndef TESTS_PLAY_TRACE_FILE_H
#define TESTS_PLAY_TRACE_FILE_H

#include <sluice/manager.h>

/** Grows as it is written; zeroed is empty. What is said first must come first. */
struct trace_file {
    uint8_t *bytes; ///< owned
    size_t size, room;
};

void trace_file_begin(struct trace_file *file, uint32_t textures, uint32_t frames);
void trace_file_add_texture(struct trace_file *file, const SluiceStreamedTextureDesc *desc,
                            uint32_t primary);
void trace_file_add_frame(struct trace_file *file, uint64_t micros, uint32_t maps);
void trace_file_add_map(struct trace_file *file, uint32_t texture, const uint8_t *map,
                        uint32_t regions);
void trace_file_finish(struct trace_file *file);

/** The first `size` bytes in a file whose name goes to `path`, of 64 characters; to be removed. */
void trace_file_write(const struct trace_file *file, size_t size, char *path);

#endif /* TESTS_PLAY_TRACE_FILE_H */
