/*
 * Walks the trees of bvh.c, for devices without ray tracing. The walk stops at triangles that may
 * have holes. So the shader samples textures in one place only: compilers inline all functions.
 */
#ifndef TRACER_BVH_GLSL
#define TRACER_BVH_GLSL

#include "../../common/box_tree.glsl"

/* Two trees: the one over instances, and the one of an instance. */
#define STACK_SIZE (2 * (BOX_TREE_MOST_DEPTH + 1))

layout(std430, set = 1, binding = TRACER_BINDING_NODES) readonly buffer Nodes
{
    TracerNode nodes[];
};

struct Hit {
    float distance; /* below 0: no hit */
    uint instance, triangle;
    vec2 weights;
};

struct Walk {
    vec3 worldOrigin, worldDirection;
    vec3 origin, direction, inverse; /* in the instance's space while inside one */
    bool any;                        /* true: any hit suffices */
    bool inside;
    uint instance, firstIndex, flags; /* fields of the current instance */
    uint height, base; /* stack height now, and at the entry into the instance */
    uint triangle, end;
    float far;
    Hit best;
};

uint walkStack[STACK_SIZE];

void setWalkRay(inout Walk walk, vec3 origin, vec3 direction)
{
    walk.origin = origin;
    walk.direction = direction;
    walk.inverse = boxTreeInverse(direction);
}

Walk startWalk(vec3 origin, vec3 direction, float far, bool any, uint root)
{
    Walk walk;
    walk.worldOrigin = origin;
    walk.worldDirection = direction;
    setWalkRay(walk, origin, direction);
    walk.any = any;
    walk.inside = false;
    walk.instance = walk.firstIndex = walk.flags = 0u;
    walk.height = 1u;
    walk.base = 0u;
    walk.triangle = walk.end = 0u;
    walk.far = far;
    walk.best.distance = -1.0;
    walkStack[0] = root;
    return walk;
}

/** Returns the distance at which the ray enters a box, or more than 1e29 if not before `far`. */
float enterBox(Walk walk, TracerNode node)
{
    float enter;
    bool enters = boxTreeEnter(vec3(node.low[0], node.low[1], node.low[2]),
                               vec3(node.high[0], node.high[1], node.high[2]), walk.origin,
                               walk.inverse, walk.far, enter);
    return enters ? enter : 1.0e30;
}

/** Intersects a triangle: Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection",
 * 1997. */
bool hitTriangle(Walk walk, uint triangle, out float distance, out vec2 weights)
{
    uint first = walk.firstIndex + 3u * triangle;
    vec3 corner = vertexPosition(indices[first]);
    vec3 edge1 = vertexPosition(indices[first + 1u]) - corner;
    vec3 edge2 = vertexPosition(indices[first + 2u]) - corner;
    vec3 p = cross(walk.direction, edge2), t = walk.origin - corner, q = cross(t, edge1);
    float volume = dot(edge1, p);
    weights = vec2(dot(t, p), dot(walk.direction, q)) / volume;
    distance = dot(edge2, q) / volume;
    return volume != 0.0 && weights.x >= 0.0 && weights.y >= 0.0 && weights.x + weights.y <= 1.0 &&
           distance > 0.0 && distance < walk.far;
}

void takeHit(inout Walk walk, Hit hit)
{
    walk.best = hit;
    walk.far = hit.distance;
}

bool isOver(Walk walk)
{
    return walk.any && walk.best.distance >= 0.0;
}

void enterInstance(inout Walk walk, uint index)
{
    TracerInstance instance = instances[index];
    setWalkRay(walk, toObject(instance, walk.worldOrigin, 1.0),
               toObject(instance, walk.worldDirection, 0.0)); /* not normalized */
    walk.inside = true;
    walk.base = walk.height;
    walk.instance = index;
    walk.firstIndex = instance.firstIndex;
    walk.flags = instance.flags;
    walkStack[walk.height++] = instance.rootNode;
}

/** Pushes both children if hit. The nearer one is visited first. */
void pushChildren(inout Walk walk, uint first)
{
    float left = enterBox(walk, nodes[first]), right = enterBox(walk, nodes[first + 1u]);
    uint nearer = first + (right < left ? 1u : 0u);
    if (max(left, right) < 1.0e29)
        walkStack[walk.height++] = 2u * first + 1u - nearer;
    if (min(left, right) < 1.0e29)
        walkStack[walk.height++] = nearer;
}

void visitNode(inout Walk walk, TracerNode node)
{
    if (node.count == 0u) {
        pushChildren(walk, node.first);
    } else if (walk.inside) {
        walk.triangle = node.first;
        walk.end = node.first + node.count;
    } else {
        enterInstance(walk, node.first);
    }
}

/**
 * Continues the walk. Returns true with a candidate that may be a hole and is nearer than the best
 * hit; call takeHit() if it is solid. Returns false at the end, with the nearest hit.
 */
bool walkOn(inout Walk walk, out Hit hit)
{
    hit = walk.best;
    while (!isOver(walk)) {
        if (walk.triangle < walk.end) {
            hit.instance = walk.instance;
            hit.triangle = walk.triangle++;
            if (!hitTriangle(walk, hit.triangle, hit.distance, hit.weights))
                continue;
            if ((walk.flags & TRACER_CUT_OUT) != 0u)
                return true;
            takeHit(walk, hit);
            continue;
        }
        if (walk.inside && walk.height == walk.base) {
            walk.inside = false;
            setWalkRay(walk, walk.worldOrigin, walk.worldDirection);
        }
        if (walk.height == 0u)
            return false;
        TracerNode node = nodes[walkStack[--walk.height]];
        if (enterBox(walk, node) < 1.0e29) /* something nearer may have been hit since the push */
            visitNode(walk, node);
    }
    return false;
}

#endif
