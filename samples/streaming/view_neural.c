#include "view_neural.h"

bool view_neural_create(struct view *view)
{
    const struct view_request *request = &view->request;
    return request->everything || neural_view_create(request->gpu, view->context, request->pictures,
                                                     request->settings, &view->neural);
}

/* Creates a surface. The truth uses the texels before compression. */
SluiceResult view_neural_create_surface(struct view *view, const struct picture *picture,
                                        struct renderer_surface *surface)
{
    const struct neural_picture *neural = picture->neural;
    enum neural_mode mode = view->request.everything ? NEURAL_RAW : neural->mode;
    const SluiceTileProducer *producer = NULL;
    SluiceVulkanTexture color;
    surface->exposure = picture->exposure;
    surface->gray = picture->gray;
    surface->decoded = mode == NEURAL_SAMPLE;
    surface->hdr = neural->hdr;
    if (surface->decoded) {
        surface->color_index = neural->texture.firstChannel;
        for (uint32_t c = 0; c < 3; c++)
            surface->relief_index |= (uint32_t)neural->from[c] << 2 * c;
        return SLUICE_SUCCESS;
    }
    if (mode == NEURAL_FEEDBACK) {
        producer = neural_view_add_producer(&view->neural, neural);
        if (!producer)
            return SLUICE_ERROR_UNSUPPORTED;
    }
    SluiceResult result = view_add_texture(view,
                                           producer                   ? NULL
                                           : view->request.everything ? neural->original
                                                                      : picture->color,
                                           producer, SLUICE_NO_TEXTURE, false, &color);
    if (result != SLUICE_SUCCESS)
        return result;
    surface->color_index = surface->relief_index = color.tableIndex;
    renderer_write_texture_set(&view->renderer, surface->textures, color.imageView, color.imageView,
                               false);
    return SLUICE_SUCCESS;
}
