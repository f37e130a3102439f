/** Files of neural textures. */
#ifndef TOOLS_SLUICE_INFO_NEURAL_FILE_H
#define TOOLS_SLUICE_INFO_NEURAL_FILE_H

#include "options.h"

#include <sluice/neural.h>

/** Opens a file; NULL, having said why. Destroy the set. */
SluiceNeuralSet *open_neural_file(const char *path);

/** Decodes a mip to a file of floats: [height][width][channels], row 0 first. An exit status. */
int decode_neural_file(const struct options *options);

#endif /* TOOLS_SLUICE_INFO_NEURAL_FILE_H */
