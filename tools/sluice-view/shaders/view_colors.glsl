// Colors and patterns of views. panels.c, panel_legend.c and memory_map.c have the same values.
#ifndef VIEW_COLORS_GLSL
#define VIEW_COLORS_GLSL

const uint VIEW_RESIDENT = 2, VIEW_MISSING = 3, VIEW_WANTED = 4, VIEW_AGE = 5, VIEW_IDENTITY = 6,
           VIEW_WRITTEN = 7, VIEW_CHECKS = 9;

const uint MARK_NOTHING = 0, MARK_COMING = 1, MARK_BUDGET = 2, MARK_FAILED = 3, MARK_NOT_SEEN = 4, MARK_LIMIT = 5;
const uint MARK_FINEST = 6; // the shader's own: the file has no finer level
const uint MARK_THRASHES = 16, MARK_OLDEST = 0xFFFFu;

const vec3 levelColors[8] = vec3[](vec3(214, 40, 40), vec3(247, 127, 0), vec3(252, 191, 73), vec3(190, 210, 110),
                                   vec3(102, 194, 165), vec3(50, 136, 189), vec3(70, 80, 170), vec3(50, 40, 100));

vec3 levelColor(uint level)
{
    return levelColors[min(level, 7u)] / 255.0;
}

vec3 missingColor(uint missing)
{
    return missing == 1u ? vec3(240, 228, 66) / 255.0 : missing == 2u ? vec3(230, 159, 0) / 255.0 : vec3(213, 94, 0) / 255.0;
}

/* Color of an image, by its number. memory_map.c has the same colors. */
vec3 identityColor(uint index)
{
    float hue = fract(float(index) * 0.61803399);
    return 0.55 + 0.4 * cos(6.2831853 * (hue + vec3(0.0, 0.33, 0.67)));
}

/* Returns true if the pixel is dark in the pattern of a reason. Patterns differ in shape, not in color. panel_legend.c
 * draws the same patterns. */
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

/* Color of an age. Colors from new to old differ in brightness. */
vec3 ageColor(float seconds)
{
    return (seconds < 0.5    ? vec3(253, 231, 37)
            : seconds < 2.0  ? vec3(122, 209, 81)
            : seconds < 10.0 ? vec3(34, 168, 132)
            : seconds < 60.0 ? vec3(42, 120, 142)
                             : vec3(65, 68, 135)) / 255.0;
}

/* Color of texels of level 0 per pixel. */
vec3 densityColor(float texels)
{
    return (texels < 0.25  ? vec3(5, 48, 97)
            : texels < 0.7 ? vec3(103, 169, 207)
            : texels < 1.5 ? vec3(247, 247, 247)
            : texels < 4.0 ? vec3(253, 174, 97)
            : texels < 16.0 ? vec3(215, 72, 39)
                           : vec3(92, 58, 20)) / 255.0; // differs from magenta, even when mixed with gray
}

#endif
