/** Files of neural textures. */
#ifndef TOOLS_SLUICE_INFO_NEURAL_FILE_H
#define TOOLS_SLUICE_INFO_NEURAL_FILE_H

#include "options.h"

#include <sluice/neural.h>

/** Opens a file. Destroy the set. Reports errors on stderr and returns NULL. */
SluiceNeuralSet *open_neural_file(const char *path);

/** Decodes a mip to a file of floats: [height][width][channels], row 0 first. Returns the exit
 * status. */
int decode_neural_file(const struct options *options);

#endif /* TOOLS_SLUICE_INFO_NEURAL_FILE_H */
