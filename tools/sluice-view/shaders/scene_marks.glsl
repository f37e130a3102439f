// Marks of tiles, written by tile_marks.c.
layout(set = 1, binding = 1, std430) readonly buffer Marks
{
    uint marks[]; // 4 words per image: first word, columns, rows, size of tiles; then a word per tile of level 0
};

uvec2 markTileSize(uint image)
{
    uint size = marks[4u * image + 3u];
    return max(uvec2(size & 0xFFFFu, size >> 16), 1u);
}

/* Returns the word of the level 0 tile at a texel of level 0. */
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
