/** sluice-bake --neural: pictures become one .ntc file. */
#ifndef TOOLS_SLUICE_BAKE_NEURAL_H
#define TOOLS_SLUICE_BAKE_NEURAL_H

#include "options.h"

/** Reports errors on stderr and returns false. */
bool neural_bake(const struct options *options);

#endif /* TOOLS_SLUICE_BAKE_NEURAL_H */
