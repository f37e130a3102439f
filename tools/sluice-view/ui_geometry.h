/** Triangles of the user interface: ui.cpp makes them, ui_draw.c draws them. */
#ifndef SLUICE_VIEW_UI_GEOMETRY_H
#define SLUICE_VIEW_UI_GEOMETRY_H

#include <stdint.h>

/** A vertex with the layout of ImDrawVert. */
struct ui_vertex {
    float x, y, u, v;
    uint32_t color; ///< 0xAABBGGRR, not linear
};

/** Textures by number. */
enum ui_texture {
    UI_TEXTURE_FONT,
    UI_TEXTURE_PICTURE,
    UI_TEXTURE_OTHER,
    UI_TEXTURE_FLIP,
    UI_TEXTURE_THUMBS,
    UI_TEXTURE_COUNT
};

/** Modes of drawing a picture. Shifted by UI_MODE_SHIFT and added to the number of a texture. */
enum ui_mode {
    UI_MODE_PLAIN,
    UI_MODE_DIFFERENCE ///< |PICTURE - OTHER| times the color's alpha * 16
};
#define UI_MODE_SHIFT 8

/** A run of triangles. */
struct ui_draw {
    int32_t clip[4]; ///< left, top, right, bottom, in pixels, within the picture
    uint32_t texture, mode;
    uint32_t first_index, index_count;
    int32_t vertex_offset;
};

struct ui_geometry {
    const struct ui_vertex *vertices;
    const uint16_t *indices;
    const struct ui_draw *draws;
    uint32_t vertex_count, index_count, draw_count;
    float width, height; ///< pixels of the picture
};

#endif /* SLUICE_VIEW_UI_GEOMETRY_H */
