/** Pictures of a neural set as surfaces of a view. */
#ifndef SAMPLES_STREAMING_VIEW_NEURAL_H
#define SAMPLES_STREAMING_VIEW_NEURAL_H

#include "view.h"

/** What the view's pictures of a neural set share; for view_create. */
bool view_neural_create(struct view *view);

/** The surface of a picture of a neural set. Errors: those of view_add_texture; UNSUPPORTED. */
SluiceResult view_neural_create_surface(struct view *view, const struct picture *picture,
                                        struct renderer_surface *surface);

/** A texture of a source or of a producer. Says on stderr why it failed. */
SluiceResult view_add_texture(struct view *view, SluiceImageSource *source,
                              const SluiceTileProducer *producer, SluiceTextureId primary,
                              bool repeat, SluiceVulkanTexture *texture);

#endif /* SAMPLES_STREAMING_VIEW_NEURAL_H */
