/** Verification of stores, tile by tile. */
#ifndef TOOLS_SLUICE_BAKE_VERIFY_H
#define TOOLS_SLUICE_BAKE_VERIFY_H

#include "../common/option_table.h"

/** Prints for each file whether it is whole. Returns false if a file is not. */
bool verify_files(const struct option_list *paths, bool json);

#endif /* TOOLS_SLUICE_BAKE_VERIFY_H */
