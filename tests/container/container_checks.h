/** Checks that DDS and KTX2 files share. */
#ifndef TESTS_CONTAINER_CHECKS_H
#define TESTS_CONTAINER_CHECKS_H

#include "container/container_files.h"

/** Opens a file. UNDEFINED: the file's format. `tally` counts log messages; may be NULL. */
typedef SluiceImageSource *open_function(const char *path, SluiceFormat format,
                                         struct log_tally *tally);

/** Shapes of pictures with odd sizes, arrays and cube maps, without a format. */
extern const struct picture picture_shapes[];
extern const uint32_t picture_shapes_count;

/** Checks that the file is read as the picture. Frees the file. */
void check_file(struct file_bytes file, const struct picture *picture, open_function *open);

/** Little-endian words written over a valid file, the expected result, and a word of the
 * message. */
struct refusal {
    uint32_t at, value;
    SluiceResult result;
    const char *message;
    uint32_t at2, value2; ///< 0: none
};

/** Checks each refusal by itself. Frees the file. */
void check_refusals(struct file_bytes file, open_function *open, const struct refusal *refusals,
                    size_t count);

/** Checks that a file of one format can be read as `other`, which has equal bytes, and not as
 * `foreign`. Frees the file. */
void check_renaming(struct file_bytes file, const struct picture *picture, open_function *open,
                    SluiceFormat other, SluiceFormat foreign);

/** Reads all of the picture on `count` threads at once. */
void check_on_threads(SluiceImageSource *source, const struct picture *picture, int count);

#endif /* TESTS_CONTAINER_CHECKS_H */
