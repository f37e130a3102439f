/**
 * Inputs and settings that a truth was drawn with, as lines of text. The frames are reused only if
 * the text is equal.
 */
#ifndef SAMPLES_STREAMING_REFERENCE_KEY_H
#define SAMPLES_STREAMING_REFERENCE_KEY_H

#include "../../tools/common/gpu.h"
#include "pictures.h"

/** Returns text that the caller frees. Returns NULL when out of memory. */
char *reference_key_create(const struct settings *settings, const struct gpu *gpu,
                           const struct picture_list *pictures);

/** Facts about the frames that are stored with the key. */
struct reference_content {
    uint32_t checksum;      ///< CRC-32 of all frames in order
    uint64_t device_memory; ///< bytes of all resident pictures
};

enum reference_match {
    REFERENCE_MATCHES,
    REFERENCE_MISSING,
    REFERENCE_DIFFERS, ///< stderr names the difference
    REFERENCE_FOREIGN, ///< not written by reference_key_write, or unreadable
};

/** Compares the key with the text file at `path`. */
enum reference_match reference_key_compare(const char *path, const char *key,
                                           struct reference_content *content);
/** Writes the file completely or not at all. Reports errors on stderr. */
bool reference_key_write(const char *path, const char *key,
                         const struct reference_content *content);

#endif /* SAMPLES_STREAMING_REFERENCE_KEY_H */
