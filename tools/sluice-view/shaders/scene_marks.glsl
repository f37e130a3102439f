// Marks of tiles, as tile_marks.c writes them, and the patterns of their reasons.
const uint MARK_NOTHING = 0, MARK_COMING = 1, MARK_BUDGET = 2, MARK_FAILED = 3, MARK_NOT_SEEN = 4, MARK_LIMIT = 5;
const uint MARK_FINEST = 6; // the shader's own: the file has no finer level
const uint MARK_THRASHES = 16, MARK_OLDEST = 0xFFFFu;

layout(set = 1, binding = 1, std430) readonly buffer Marks
{
    uint marks[]; // 4 words per image: first word, columns, rows, size of tiles; then a word per tile of level 0
};

uvec2 markTileSize(uint image)
{
    uint size = marks[4u * image + 3u];
    return max(uvec2(size & 0xFFFFu, size >> 16), 1u);
}

/* Word of the tile of level 0 at a texel of level 0. */
uint markAt(uint image, uvec2 texel)
{
    uvec2 size = uvec2(marks[4u * image + 1u], marks[4u * image + 2u]);
    uvec2 at = min(texel / markTileSize(image), size - 1u);
    return marks[marks[4u * image] + at.y * size.x + at.x];
}

uint markReason(uint word)
{
    return word & 15u;
}

/* Seconds since the tile was loaded. */
float markAge(uint word)
{
    return float(word >> 16) / 16.0;
}

/* Whether the pixel is dark in the pattern of a reason. Patterns differ in shape, not in color. panel_legend.c draws
 * them, too. */
bool markPattern(uint reason, uvec2 at)
{
    uvec2 cell = at % 12u;
    switch (reason) {
    case MARK_COMING: return all(lessThan(abs(vec2(cell) - 5.5), vec2(2.0)));
    case MARK_BUDGET: return (at.x + at.y) % 12u < 3u;
    case MARK_FAILED: return (at.x + at.y) % 12u < 2u || (at.x + 12000u - at.y) % 12u < 2u;
    case MARK_NOT_SEEN: return at.y % 8u < 2u;
    case MARK_LIMIT: return at.x % 8u < 2u;
    case MARK_FINEST: return (cell.x < 6u) != (cell.y < 6u);
    default: return false;
    }
}

/* From new to old, colors that differ in brightness. */
vec3 ageColor(float seconds)
{
    return (seconds < 0.5    ? vec3(253, 231, 37)
            : seconds < 2.0  ? vec3(122, 209, 81)
            : seconds < 10.0 ? vec3(34, 168, 132)
            : seconds < 60.0 ? vec3(42, 120, 142)
                             : vec3(65, 68, 135)) / 255.0;
}

/* Texels of level 0 per pixel, in a direction of a pixel. */
vec3 densityColor(float texels)
{
    return (texels < 0.25  ? vec3(5, 48, 97)
            : texels < 0.7 ? vec3(103, 169, 207)
            : texels < 1.5 ? vec3(247, 247, 247)
            : texels < 4.0 ? vec3(253, 174, 97)
            : texels < 16.0 ? vec3(215, 72, 39)
                           : vec3(92, 58, 20)) / 255.0; // unlike magenta, also mixed with gray
}
