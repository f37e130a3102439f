/** Surfaces of a view from pictures of a neural set. */
#ifndef SAMPLES_STREAMING_VIEW_NEURAL_H
#define SAMPLES_STREAMING_VIEW_NEURAL_H

#include "view.h"

/** Creates the objects that all pictures of a neural set share. Called by view_create. */
bool view_neural_create(struct view *view);

/** Creates the surface of a picture of a neural set. Errors: those of view_add_texture;
 * UNSUPPORTED. */
SluiceResult view_neural_create_surface(struct view *view, const struct picture *picture,
                                        struct renderer_surface *surface);

/** Adds a texture of a source or of a producer. Reports errors on stderr. */
SluiceResult view_add_texture(struct view *view, SluiceImageSource *source,
                              const SluiceTileProducer *producer, SluiceTextureId primary,
                              bool repeat, SluiceVulkanTexture *texture);

#endif /* SAMPLES_STREAMING_VIEW_NEURAL_H */
