/*
 * Contents of the texture: the number of steps in which a point of the plane leaves the Mandelbrot
 * set. Computed in integers, so that every device gives every texel the same byte.
 */

#define FRACTAL_ONE 28 /* bits behind the binary point: numbers are below 8 */

/* Returns a * b. Both factors and the product must be below 8. */
int multiply(int a, int b)
{
    int high, low;
    imulExtended(a, b, high, low);
    return int(uint(high) << (32 - FRACTAL_ONE) | uint(low) >> FRACTAL_ONE);
}

/* Returns the steps of the center of a texel, in a level of 2^bits x 2^bits texels. The texture is 3
 * by 3 units of the plane. */
uint fractalSteps(uint bits, uvec2 texel)
{
    int halfTexel = (3 << (FRACTAL_ONE - 1 - 20)) << (20 - int(bits)); /* half the width of a texel */
    ivec2 corner = ivec2(9 << (FRACTAL_ONE - 2), 6 << (FRACTAL_ONE - 2)); /* (2.25, 1.5) */
    ivec2 c = ivec2(2u * texel + 1u) * halfTexel - corner;
    int x = 0, y = 0;
    for (uint i = 0u; i < FRACTAL_MOST_STEPS; i++) {
        if (abs(x) > (2 << FRACTAL_ONE) || abs(y) > (2 << FRACTAL_ONE))
            return i;
        int xx = multiply(x, x), yy = multiply(y, y);
        if (uint(xx) + uint(yy) > (4u << FRACTAL_ONE))
            return i;
        y = 2 * multiply(x, y) + c.y;
        x = xx - yy + c.x;
    }
    return FRACTAL_MOST_STEPS;
}
