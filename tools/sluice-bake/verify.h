/** Stores read tile by tile, to see whether they are what they were. */
#ifndef TOOLS_SLUICE_BAKE_VERIFY_H
#define TOOLS_SLUICE_BAKE_VERIFY_H

#include "../common/option_table.h"

/** Says of each file whether it is whole. False if one is not. */
bool verify_files(const struct option_list *paths, bool json);

#endif /* TOOLS_SLUICE_BAKE_VERIFY_H */
