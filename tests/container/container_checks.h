/** What DDS and KTX2 files have in common to be checked. */
#ifndef TESTS_CONTAINER_CHECKS_H
#define TESTS_CONTAINER_CHECKS_H

#include "container/container_files.h"

/** UNDEFINED: the file's format; `tally`, or NULL, takes what is logged. */
typedef SluiceImageSource *open_function(const char *path, SluiceFormat format,
                                         struct log_tally *tally);

/** Sizes, arrays and cube maps that are odd in every way, without a format. */
extern const struct picture picture_shapes[];
extern const uint32_t picture_shapes_count;

/** The file, which is freed, is read and is the picture. */
void check_file(struct file_bytes file, const struct picture *picture, open_function *open);

/** Little-endian words written over a good file, what that makes of it, and a word of the message.
 */
struct refusal {
    uint32_t at, value;
    SluiceResult result;
    const char *message;
    uint32_t at2, value2; ///< 0: none
};

/** Each of them by itself. Frees the file. */
void check_refusals(struct file_bytes file, open_function *open, const struct refusal *refusals,
                    size_t count);

/** A file that has one format can be asked for as `other`, which has the same bytes, and as
 *  `foreign`, which has not, it is refused. Frees the file. */
void check_renaming(struct file_bytes file, const struct picture *picture, open_function *open,
                    SluiceFormat other, SluiceFormat foreign);

/** All of the picture on so many threads at once. */
void check_on_threads(SluiceImageSource *source, const struct picture *picture, int count);

#endif /* TESTS_CONTAINER_CHECKS_H */
