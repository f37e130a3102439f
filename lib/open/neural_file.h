/** Textures of neural sets, by name. */
#ifndef SLC_OPEN_NEURAL_FILE_H
#define SLC_OPEN_NEURAL_FILE_H

#include <sluice/image.h>
#include <sluice/input.h>

/** Opens the texture with a name; NULL: the first texture. `input` NULL: opens the file. Errors,
 * logged: the same as sluiceOpenNamedImageSource. */
SluiceResult slc_neural_file_open(const char *path, const SluiceInput *input, const char *texture,
                                  SluiceFilePool *pool, const SluiceAllocationCallbacks *cb,
                                  const SluiceLogCallback *log, SluiceImageSource **source);

#endif /* SLC_OPEN_NEURAL_FILE_H */
