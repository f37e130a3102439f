/** Textures of neural sets, by name. */
#ifndef SLC_OPEN_NEURAL_FILE_H
#define SLC_OPEN_NEURAL_FILE_H

#include <sluice/image.h>
#include <sluice/input.h>

/** Opens the texture of that name; NULL: the first one. `input` NULL: the file. Errors: as
 * sluiceOpenNamedImageSource, logged. */
SluiceResult slc_neural_file_open(const char *path, const SluiceInput *input, const char *texture,
                                  SluiceFilePool *pool, const SluiceAllocationCallbacks *cb,
                                  const SluiceLogCallback *log, SluiceImageSource **source);

#endif /* SLC_OPEN_NEURAL_FILE_H */
