/** Opens sets for tests: bytes in memory, and the sample files beside the checkout. */
#ifndef TESTS_NEURAL_NEURAL_FILES_H
#define TESTS_NEURAL_NEURAL_FILES_H

#include <sluice/neural.h>

/** Opens bytes. `cb` may be NULL. */
SluiceResult open_neural_bytes(const uint8_t *bytes, size_t size,
                               const SluiceAllocationCallbacks *cb, SluiceNeuralSet **set);

/** Writes the path of a sample. False, for SKIP_TEST, if the file is not there. */
bool find_neural_sample(const char *name, char *path, size_t size);

/** Returns 0 if all samples exist, else prints "all skipped" in TAP and returns 77. Call in main.
 * `names` ends with NULL. */
int need_neural_samples(const char *const *names);

/** Opens a sample that is there. */
SluiceNeuralSet *open_neural_sample(const char *path);

/** Reads a file as a whole; to be freed. */
uint8_t *read_neural_file(const char *path, size_t *size);

#endif /* TESTS_NEURAL_NEURAL_FILES_H */
