/**
 * What the frames of a truth were drawn of, and how: lines of text that must be the same for them
 * to be used again.
 */
#ifndef SAMPLES_STREAMING_REFERENCE_KEY_H
#define SAMPLES_STREAMING_REFERENCE_KEY_H

#include "../../tools/common/gpu.h"
#include "pictures.h"

/** For the caller to free; NULL if out of memory. */
char *reference_key_create(const struct settings *settings, const struct gpu *gpu,
                           const struct picture_list *pictures);

/** What else is known of the frames. */
struct reference_content {
    uint32_t checksum;      ///< CRC-32 of all frames, one after another
    uint64_t device_memory; ///< bytes that everything resident took
};

enum reference_match {
    REFERENCE_MATCHES,
    REFERENCE_MISSING,
    REFERENCE_DIFFERS, ///< stderr says in what
    REFERENCE_FOREIGN, ///< What is there was not written by reference_key_write, or cannot be read.
};

/** Compares the key with the text file at `path`. */
enum reference_match reference_key_compare(const char *path, const char *key,
                                           struct reference_content *content);
/** Complete or, if it fails, absent; stderr says why. */
bool reference_key_write(const char *path, const char *key,
                         const struct reference_content *content);

#endif /* SAMPLES_STREAMING_REFERENCE_KEY_H */
