/* Ray tests against the boxes of trees that box_tree.c builds. */
#ifndef SAMPLES_BOX_TREE_GLSL
#define SAMPLES_BOX_TREE_GLSL

#define BOX_TREE_MOST_DEPTH 30

/** Returns 1 / direction, but finite, so that products with it are never NaN. */
vec3 boxTreeInverse(vec3 direction)
{
    const float LEAST = 1.0e-37;
    vec3 least = mix(vec3(LEAST), vec3(-LEAST), lessThan(direction, vec3(0.0)));
    return 1.0 / mix(direction, least, lessThan(abs(direction), vec3(LEAST)));
}

/**
 * Returns whether a ray enters a box before `far`. `enter`: distance at which it does, at least 0.
 * The box is enlarged by 1e-6 of the distance to its farthest corner, so that rounding never makes
 * a ray miss the box of something that it hits. Rays may begin in faces and run along them.
 */
bool boxTreeEnter(vec3 low, vec3 high, vec3 origin, vec3 inverse, float far, out float enter)
{
    vec3 toLow = low - origin, toHigh = high - origin;
    vec3 reach = max(abs(toLow), abs(toHigh));
    float more = 1.0e-6 * max(reach.x, max(reach.y, reach.z));
    vec3 a = (toLow - more) * inverse, b = (toHigh + more) * inverse;
    vec3 first = min(a, b), last = max(a, b);
    enter = max(max(first.x, first.y), max(first.z, 0.0));
    return enter <= min(min(last.x, last.y), min(last.z, far));
}

#endif
