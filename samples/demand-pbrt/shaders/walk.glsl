/*
 * Finds a ray's nearest hit without the device's ray tracing. Walks the tree of the world
 * (top_tree.c) and the trees of meshes (mesh_tree.c).
 *
 * Include scene.glsl and box.glsl before. The nearest hit does not depend on the order in which the
 * trees are built or walked. Among triangles at equal distance, the first one in the scene wins.
 * Boxes win over triangles.
 */
#ifndef PBRT_WALK_GLSL
#define PBRT_WALK_GLSL

#include "../../common/box_tree.glsl"

layout(std430, set = 1, binding = PBRT_BINDING_WORLD) readonly buffer World
{
    uint worldNodes[2]; /* device address of the world's tree */
};
layout(std430, set = 1, binding = PBRT_BINDING_INSTANCES) readonly buffer Instances
{
    PbrtInstance instances[];
};
/** A node has two elements: see box_tree.h. */
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Nodes
{
    uvec4 at[];
};

/** A hit on a triangle or a box. */
struct Spot {
    float distance;
    uint place;    /* place, or box; PBRT_NONE: no hit */
    uint triangle; /* in the order of leaves; PBRT_NONE: the hit is a box */
    vec2 weights;
    uint face; /* face of the box */
};

struct Walk {
    vec3 worldOrigin, worldDirection;
    vec3 origin, direction, inverse; /* in the mesh's space while inside a mesh */
    bool inside, opaque;
    uint place;
    uvec2 nodes; /* device address of the current tree */
    uint height, base;  /* stack height now, and at the entry into the mesh */
    uint triangle, end; /* triangles of the current leaf */
    vec3 shear;         /* shear of the ray, see intersectTriangle */
    uint axis;
    Spot best;
};

uint walkStack[2 * (BOX_TREE_MOST_DEPTH + 1)];

void setWalkRay(inout Walk walk, vec3 origin, vec3 direction)
{
    walk.origin = origin;
    walk.direction = direction;
    walk.inverse = boxTreeInverse(direction);
}

Walk startWalk(vec3 origin, vec3 direction, float far)
{
    Walk walk;
    walk.worldOrigin = origin;
    walk.worldDirection = direction;
    setWalkRay(walk, origin, direction);
    walk.inside = walk.opaque = false;
    walk.place = PBRT_NONE;
    walk.nodes = uvec2(worldNodes[0], worldNodes[1]);
    walk.height = 1u;
    walk.base = 0u;
    walk.triangle = walk.end = 0u;
    walk.shear = vec3(0.0);
    walk.axis = 0u;
    walk.best = Spot(far, PBRT_NONE, PBRT_NONE, vec2(0.0), 0u);
    walkStack[0] = 0u;
    return walk;
}

/** Rotates the components so that the ray's largest axis becomes z. */
vec3 permute(vec3 v, uint axis)
{
    return axis == 0u ? v.yzx : axis == 1u ? v.zxy : v;
}

/** Multiplies by a 3 x 3 matrix, stored by rows. */
vec3 turn(float m[9], vec3 v)
{
    return vec3(dot(vec3(m[0], m[1], m[2]), v), dot(vec3(m[3], m[4], m[5]), v),
                dot(vec3(m[6], m[7], m[8]), v));
}

void enterInstance(inout Walk walk, uint place)
{
    float toObject[9] = instances[place].toObject;
    vec3 at = vec3(instances[place].toWorld[3], instances[place].toWorld[7],
                   instances[place].toWorld[11]);
    setWalkRay(walk, turn(toObject, walk.worldOrigin - at),
               turn(toObject, walk.worldDirection)); /* keeps its length, so distances stay valid */
    vec3 size = abs(walk.direction);
    walk.axis = size.x > size.y ? (size.x > size.z ? 0u : 2u) : (size.y > size.z ? 1u : 2u);
    vec3 d = permute(walk.direction, walk.axis);
    walk.shear = vec3(d.xy, 1.0) / d.z;
    walk.place = place;
    walk.opaque = (instances[place].flags & PBRT_INSTANCE_OPAQUE) != 0u;
    walk.nodes = uvec2(instances[place].nodes[0], instances[place].nodes[1]);
    walk.inside = true;
    walk.base = walk.height;
    walkStack[walk.height++] = 0u;
}

/**
 * Intersects a triangle: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", 2013.
 * Triangles with common corners leave no gaps. Both sides are hit. Edges belong to both triangles.
 */
bool intersectTriangle(Walk walk, uint triangle, out float distance, out vec2 weights)
{
    PbrtMesh mesh = meshes[places[walk.place].mesh];
    Words words = Words(uvec2(mesh.address[0], mesh.address[1]));
    uint first = mesh.indices + 3u * triangle;
    precise vec3 a = permute(readVector(words, 3u * words.at[first]) - walk.origin, walk.axis);
    precise vec3 b = permute(readVector(words, 3u * words.at[first + 1u]) - walk.origin, walk.axis);
    precise vec3 c = permute(readVector(words, 3u * words.at[first + 2u]) - walk.origin, walk.axis);
    a.xy -= walk.shear.xy * a.z;
    b.xy -= walk.shear.xy * b.z;
    c.xy -= walk.shear.xy * c.z;
    precise float u = c.x * b.y - c.y * b.x;
    precise float v = a.x * c.y - a.y * c.x;
    precise float w = b.x * a.y - b.y * a.x;
    precise float sum = u + v + w;
    distance = walk.shear.z * (u * a.z + v * b.z + w * c.z) / sum;
    weights = vec2(v, w) / sum;
    return !(min(u, min(v, w)) < 0.0 && max(u, max(v, w)) > 0.0) && sum != 0.0 && distance > 0.0 &&
           distance <= walk.best.distance;
}

/** Orders two spots at equal distance: by shape, instance and triangle. */
bool isNamedBefore(Spot one, Spot other)
{
    uvec3 a = uvec3(places[one.place].shape, places[one.place].instance, one.triangle);
    uvec3 b = uvec3(places[other.place].shape, places[other.place].instance, other.triangle);
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/** Returns whether `spot` replaces the best spot. It is not farther than the best one. */
bool isBetter(Walk walk, Spot spot)
{
    bool isBox = spot.triangle == PBRT_NONE, bestIsBox = walk.best.triangle == PBRT_NONE;
    if (spot.distance < walk.best.distance)
        return true;
    if (walk.best.place == PBRT_NONE) /* the ray ends here; the end is not part of it */
        return false;
    if (isBox || bestIsBox)
        return isBox && (!bestIsBox || spot.place < walk.best.place);
    return isNamedBefore(spot, walk.best);
}

/** Pushes both children if hit. The nearer one is visited first. */
void pushChildren(inout Walk walk, uint first)
{
    float left, right;
    Nodes nodes = Nodes(walk.nodes);
    uint at = 2u * first;
    bool hitsLeft = boxTreeEnter(uintBitsToFloat(nodes.at[at].xyz),
                                 uintBitsToFloat(nodes.at[at + 1u].xyz), walk.origin, walk.inverse,
                                 walk.best.distance, left);
    bool hitsRight = boxTreeEnter(uintBitsToFloat(nodes.at[at + 2u].xyz),
                                  uintBitsToFloat(nodes.at[at + 3u].xyz), walk.origin,
                                  walk.inverse, walk.best.distance, right);
    uint nearer = first + uint(hitsRight && !(hitsLeft && left <= right));
    if (hitsLeft && hitsRight)
        walkStack[walk.height++] = 2u * first + 1u - nearer;
    if (hitsLeft || hitsRight)
        walkStack[walk.height++] = nearer;
}

/** Visits an item of the world's tree: a placed shape, or a box. */
void visitItem(inout Walk walk, uint item)
{
    if (item == PBRT_NONE)
        return;
    if ((item & PBRT_ITEM_BOX) == 0u) {
        enterInstance(walk, item);
        return;
    }
    Spot spot = Spot(0.0, item & ~PBRT_ITEM_BOX, PBRT_NONE, vec2(0.0), 0u);
    if (intersectBox(spot.place, walk.origin, walk.direction, walk.best.distance, spot.distance,
                     spot.face) &&
        isBetter(walk, spot))
        walk.best = spot;
}

/** Tests the node again: since it was pushed, something nearer may have been hit. */
void visitNode(inout Walk walk, uint node)
{
    float enter;
    Nodes nodes = Nodes(walk.nodes);
    uvec4 low = nodes.at[2u * node], high = nodes.at[2u * node + 1u];
    if (!boxTreeEnter(uintBitsToFloat(low.xyz), uintBitsToFloat(high.xyz), walk.origin,
                      walk.inverse, walk.best.distance, enter))
        return;
    if (high.w == 0u) {
        pushChildren(walk, low.w);
    } else if (walk.inside) {
        walk.triangle = low.w;
        walk.end = low.w + high.w;
    } else {
        visitItem(walk, low.w);
    }
}

/** Visits the next node. Returns false at the end. */
bool visitNext(inout Walk walk)
{
    if (walk.inside && walk.height == walk.base) {
        walk.inside = false;
        walk.nodes = uvec2(worldNodes[0], worldNodes[1]);
        setWalkRay(walk, walk.worldOrigin, walk.worldDirection);
    }
    if (walk.height == 0u)
        return false;
    visitNode(walk, walkStack[--walk.height]);
    return true;
}

/**
 * Continues the walk. Returns true with a candidate triangle that may be a hole; the caller stores
 * it in walk.best if it is solid. Returns false at the end, with the nearest hit.
 */
bool walkOn(inout Walk walk, out Spot spot)
{
    spot = walk.best;
    for (;;) {
        if (walk.triangle == walk.end) {
            if (visitNext(walk))
                continue;
            spot = walk.best;
            return false;
        }
        spot.place = walk.place;
        spot.triangle = walk.triangle++;
        if (!intersectTriangle(walk, spot.triangle, spot.distance, spot.weights) ||
            !isBetter(walk, spot))
            continue;
        if (!walk.opaque)
            return true;
        walk.best = spot;
    }
}

/** Returns the number of a triangle in its file. */
uint triangleInFile(Spot spot)
{
    PbrtMesh mesh = meshes[places[spot.place].mesh];
    return Words(uvec2(mesh.address[0], mesh.address[1])).at[mesh.order + spot.triangle];
}

#endif
