/** Pictures of a bake: one, or several for layers. */
#ifndef SLC_BAKE_INPUTS_H
#define SLC_BAKE_INPUTS_H

#include <sluice/bake.h>

struct slc_bake_inputs {
    const SluiceBakeInfo *info;
    uint32_t count; ///< pictures, at least 1
    uint64_t size;  ///< bytes of all files
    int64_t time;   ///< time of the latest change of a file, in nanoseconds since 1970
    uint64_t hash;  ///< hash of name, size and time of each file, and `cube`; 0 for one picture
};

/**
 * Checks that `info` names pictures, and looks at their files. Errors: INVALID_ARGUMENT,
 * NULL_POINTER, FILE_NOT_FOUND, IO; the first and the last two are logged.
 */
SluiceResult slc_bake_inputs_init(struct slc_bake_inputs *inputs, const SluiceBakeInfo *info,
                                  const SluiceLogCallback *log);

/** Returns the path of a picture; NULL for pInput without a name and for sources. */
const char *slc_bake_input_path(const struct slc_bake_inputs *inputs, uint32_t index);

/** True if all pictures are files that are read with all levels. */
bool slc_bake_inputs_are_files(const struct slc_bake_inputs *inputs);

/** Returns the name without folders, because stores are moved together with their pictures. */
const char *slc_base_name(const char *path);

#endif /* SLC_BAKE_INPUTS_H */
