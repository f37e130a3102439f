/* Ways down the hierarchies that bvh.c builds, for devices that trace no rays themselves. */
#ifndef TRACER_BVH_GLSL
#define TRACER_BVH_GLSL

layout(std430, set = 1, binding = TRACER_BINDING_NODES) readonly buffer Nodes
{
    TracerNode nodes[];
};

struct Ray {
    vec3 origin, direction;
    Cone cone;
    float far;        /* of what was hit last */
    bool any;         /* whatever is hit first will do */
    bool hit;
    bool complete;    /* all holes on the way were resident */
    uint instance, triangle;
    vec2 weights;
};

/** How far a ray is when it enters a box; beyond `far` if it does not. */
float enterBox(TracerNode node, vec3 origin, vec3 inverse, float far)
{
    vec3 a = (vec3(node.low[0], node.low[1], node.low[2]) - origin) * inverse;
    vec3 b = (vec3(node.high[0], node.high[1], node.high[2]) - origin) * inverse;
    vec3 near3 = min(a, b), far3 = max(a, b);
    float enter = max(max(near3.x, near3.y), max(near3.z, 0.0));
    /* a little wider than it is: rounding must not lose what lies in the box's side */
    float leave = min(min(far3.x, far3.y), far3.z) * 1.000001 + 1.0e-7;
    return enter <= min(leave, far) ? enter : 1.0e30;
}

/** Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997. */
bool hitTriangle(uint firstIndex, uint triangle, vec3 origin, vec3 direction, out float distance,
                 out vec2 weights)
{
    uint first = firstIndex + 3u * triangle;
    vec3 corner = vertexPosition(indices[first]);
    vec3 edge1 = vertexPosition(indices[first + 1u]) - corner;
    vec3 edge2 = vertexPosition(indices[first + 2u]) - corner;
    vec3 p = cross(direction, edge2), t = origin - corner, q = cross(t, edge1);
    float volume = dot(edge1, p);
    weights = vec2(dot(t, p), dot(direction, q)) / volume;
    distance = dot(edge2, q) / volume;
    return volume != 0.0 && weights.x >= 0.0 && weights.y >= 0.0 && weights.x + weights.y <= 1.0 &&
           distance > 0.0;
}

void hitTriangles(inout Ray ray, uint instanceIndex, TracerInstance instance, TracerNode node,
                  vec3 origin, vec3 direction)
{
    for (uint i = node.first; i < node.first + node.count; i++) {
        float distance;
        vec2 weights;
        if (!hitTriangle(instance.firstIndex, i, origin, direction, distance, weights) ||
            distance >= ray.far)
            continue;
        if ((instance.flags & TRACER_CUT_OUT) != 0u &&
            isHole(instanceIndex, i, weights, ray.direction,
                   ray.cone.width + ray.cone.spread * distance, ray.complete))
            continue;
        ray.far = distance;
        ray.hit = true;
        ray.instance = instanceIndex;
        ray.triangle = i;
        ray.weights = weights;
    }
}

/* Both walks go to the nearer child first. */
#define WALK(root, from, along, leafStatement)                                                     \
    uint stack[TRACER_STACK_SIZE];                                                                 \
    uint height = 0u, at = root;                                                                   \
    vec3 inverse = 1.0 / (along);                                                                  \
    while (!(ray.any && ray.hit)) {                                                                \
        TracerNode node = nodes[at];                                                               \
        if (node.count == 0u) {                                                                    \
            float left = enterBox(nodes[node.first], from, inverse, ray.far);                      \
            float right = enterBox(nodes[node.first + 1u], from, inverse, ray.far);                \
            uint nearer = node.first + (right < left ? 1u : 0u);                                   \
            if (max(left, right) < 1.0e30)                                                         \
                stack[height++] = 2u * node.first + 1u - nearer;                                   \
            if (min(left, right) < 1.0e30) {                                                       \
                at = nearer;                                                                       \
                continue;                                                                          \
            }                                                                                      \
        } else {                                                                                   \
            leafStatement;                                                                         \
        }                                                                                          \
        if (height == 0u)                                                                          \
            break;                                                                                 \
        at = stack[--height];                                                                      \
    }

void hitInstance(inout Ray ray, uint index)
{
    TracerInstance instance = instances[index];
    vec3 origin = toObject(instance, ray.origin, 1.0);
    vec3 direction = toObject(instance, ray.direction, 0.0); /* keeps distances */
    WALK(instance.rootNode, origin, direction,
         hitTriangles(ray, index, instance, node, origin, direction))
}

void hitScene(inout Ray ray, uint root)
{
    WALK(root, ray.origin, ray.direction, hitInstance(ray, node.first))
}

#endif
