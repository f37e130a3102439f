/** Limit of open files, and descriptors that are kept for outputs. */
#ifndef TOOLS_COMMON_DESCRIPTORS_H
#define TOOLS_COMMON_DESCRIPTORS_H

#define DESCRIPTORS_KEPT_MAX 240

/** Raises the soft limit of open files to the hard limit, if possible. */
void descriptors_raise(void);

/** Descriptors that inputs cannot take. Zeroed keeps none. */
struct descriptors_kept {
    int numbers[DESCRIPTORS_KEPT_MAX];
    unsigned count;
};

/**
 * Keeps `count` descriptors until descriptors_release, but not more than a quarter of the limit.
 * Call before inputs are opened; release before outputs are opened.
 */
void descriptors_keep(struct descriptors_kept *kept, unsigned count);
void descriptors_release(struct descriptors_kept *kept);

#endif /* TOOLS_COMMON_DESCRIPTORS_H */
