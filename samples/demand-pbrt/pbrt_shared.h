/* Structs and numbers that the host code and the shaders of demand-pbrt share. */
#ifndef PBRT_SHARED_H
#define PBRT_SHARED_H

#include "sluice/shared/types.h"

#define PBRT_PAGE_CAPACITY 0x04000000u /* pageCapacity */
#define PBRT_MOST_REQUESTS 0x00020000u /* of a launch: boxes, materials, tiles */

/* Descriptor set 1; set 0 is the demand loader's. */
#define PBRT_BINDING_MESHES 0
#define PBRT_BINDING_PLACES 1
#define PBRT_BINDING_SURFACES 2
#define PBRT_BINDING_OPS 3
#define PBRT_BINDING_LIGHTS 4
#define PBRT_BINDING_FILM 5
#define PBRT_BINDING_LATEST 6
#define PBRT_BINDING_LISTS 7
#define PBRT_BINDING_COUNTERS 8
#define PBRT_BINDING_WANTED 9
#define PBRT_BINDING_USED 10
#define PBRT_BINDING_BOXES 11
#define PBRT_BINDING_DEBUG 12
#define PBRT_BINDING_EMITTERS 13
#define PBRT_BINDING_WORLD 14     /* of the compute path */
#define PBRT_BINDING_INSTANCES 15 /* ... */
#define PBRT_OWN_BUFFERS 16
#define PBRT_BINDING_SCENE 16 /* the acceleration structure, of pipelines alone */

#define PBRT_ROW_WIDTH 1024 /* rays of one row of a launch */
#define PBRT_GROUP_SIZE 64  /* threads of the compute path */
#define PBRT_NONE 0xffffffffu
#define PBRT_MAX_BOUNCES 8

/* Hit groups. Instances of the top level name them as offset into the shader table. */
#define PBRT_GROUP_MESH 0
#define PBRT_GROUP_BOX 1

/* A mesh in memory: 32-bit words from `address` on. Offsets are in words. */
struct PbrtMesh {
    uint address[2]; /* of the positions, 3 words each */
    uint normals;    /* 0: none */
    uint uvs;        /* 0: none */
    uint indices;
    /* Of the compute path, whose indices are in the order of the tree's leaves: */
    uint order; /* the file's number of each triangle */
    uint reserved[2];
};
SLUICE_SHARED_SIZE(struct PbrtMesh, 32)

/* Items of the tree over the world: places, or boxes with this bit. */
#define PBRT_ITEM_BOX 0x80000000u

#define PBRT_INSTANCE_OPAQUE 1u /* PbrtInstance.flags */

/* Where a place is, for the compute path. */
struct PbrtInstance {
    float toWorld[12]; /* three rows of four */
    float toObject[9]; /* the inverse, for directions */
    uint nodes[2];     /* address of the mesh's tree */
    uint flags;
};
SLUICE_SHARED_SIZE(struct PbrtInstance, 96)

/* PbrtPlace.flags */
#define PBRT_PLACE_REVERSED 1u  /* the geometric normal is opposite to the order of the corners */
#define PBRT_PLACE_NEGATED 2u   /* the file's normals are negated */
#define PBRT_PLACE_EMITS 4u     /* `light` is an area light */
#define PBRT_PLACE_TWO_SIDED 8u /* ... that also emits on the back */
#define PBRT_PLACE_LISTED 16u   /* ... whose triangles are PbrtEmitters */

/* A shape in the world. */
struct PbrtPlace {
    uint mesh;
    uint surface; /* of the material */
    uint alpha;   /* surface of the alpha texture, or PBRT_NONE */
    float alphaValue;
    uint flags;
    uint light;
    uint shape;
    uint instance; /* PBRT_NONE: a shape that is no part of an object */
};
SLUICE_SHARED_SIZE(struct PbrtPlace, 32)

/* PbrtSurface.kind: as SluicePbrtMaterialKind, and: */
#define PBRT_SURFACE_GLOSSY 1u
#define PBRT_SURFACE_MIRROR 2u
#define PBRT_SURFACE_GLASS 3u
#define PBRT_SURFACE_ALPHA 8u

/* A material, or an alpha texture. */
struct PbrtSurface {
    uint realized; /* 0: only asked for */
    uint kind;
    uint diffuse; /* programs: index of their first op, or PBRT_NONE for 0 */
    uint specular;
    uint transmission;
    uint reserved0;
    float roughness;
    float eta;
};
SLUICE_SHARED_SIZE(struct PbrtSurface, 32)

/* Ops of programs that compute textures on a stack. */
#define PBRT_OP_END 0u
#define PBRT_OP_CONSTANT 1u /* pushes `value` */
#define PBRT_OP_IMAGE 2u    /* pushes a sample of the demand texture `texture` */
#define PBRT_OP_SCALE 3u    /* pops two, pushes their product */
#define PBRT_OP_MIX 4u      /* pops amount, b, a; pushes a * (1 - amount) + b * amount */
#define PBRT_OP_CHECKER 5u  /* goes on with the next op, or in odd fields at `target` */
#define PBRT_OP_JUMP 6u     /* goes on at `target` */
#define PBRT_STACK 8

/* PbrtOp.flags */
#define PBRT_OP_INVERT 1u
#define PBRT_OP_DECODE 2u /* texels are sRGB although the format does not say so */
#define PBRT_OP_ENCODE 4u /* texels are linear although the format says sRGB */
#define PBRT_OP_HAS_ALPHA 8u
#define PBRT_OP_FLOAT 16u       /* one number: the luminance of a color */
#define PBRT_OP_MAPPING_SHIFT 8 /* SluicePbrtMapping */

struct PbrtOp {
    uint op;
    uint flags;
    uint texture;
    uint target;
    float value[4];
    float scale[2], delta[2];
    float axes[6];
    float factor; /* of texels */
    float gamma;  /* 0: none */
    float worldToTexture[12];
};
SLUICE_SHARED_SIZE(struct PbrtOp, 128)

struct PbrtLight {
    uint kind;      /* SluicePbrtLightKind */
    uint texture;   /* of the sky, or PBRT_NONE */
    uint skyLayout; /* SluicePbrtSkyLayout */
    float cosInner;
    float color[3];
    float cosOuter;
    float position[3];
    float density; /* of chosen points per area, where the light is a shape */
    float direction[3];
    uint reserved;
    float worldToLight[12];
};
SLUICE_SHARED_SIZE(struct PbrtLight, 112)

/* A triangle that emits, in the world. Paths choose one by its power. */
struct PbrtEmitter {
    float corner[3];
    float below; /* share of the power that the emitters before have */
    float side1[3];
    uint light;
    float side2[3];
    uint isTwoSided;
    float outside[3]; /* of length 1 */
    uint reserved;
};
SLUICE_SHARED_SIZE(struct PbrtEmitter, 64)

/* What --debug tells of a pixel's first ray. */
struct PbrtDebug {
    uint pixel; /* written by the host: PBRT_NONE for none */
    uint kind;  /* 0: not traced, 1: nothing hit, 2: a box, 3: a shape */
    uint place; /* or the box */
    uint triangle;
    float distance;
    uint missing;
    float diffuse[3];
    uint reserved;
};
SLUICE_SHARED_SIZE(struct PbrtDebug, 40)

/* PbrtLaunch.mode: --render-mode */
#define PBRT_MODE_PRIMARY 0u
#define PBRT_MODE_NEAR 1u
#define PBRT_MODE_DISTANT 2u
#define PBRT_MODE_PATH 3u

/* PbrtLaunch.flags */
#define PBRT_LAUNCH_ORTHOGRAPHIC 1u
#define PBRT_LAUNCH_FACE_FORWARD 2u
#define PBRT_LAUNCH_VERSION_4 4u  /* alpha is a probability */
#define PBRT_LAUNCH_LIST_ONE 8u   /* list 1 is read, 0 is written */
#define PBRT_LAUNCH_HEADLIGHT 16u /* all lights are shapes */
#define PBRT_LAUNCH_DARK_SKY 32u  /* no light comes from infinity: ambient light is white */
#define PBRT_LAUNCH_GRAY 64u      /* boxes and surfaces that are not made are gray */

/* Constants of the pipeline */
#define PBRT_CONSTANT_PREVIEW 0 /* coarser texels are seen where finer ones are missing */

/* Push constants of one launch. */
struct PbrtLaunch {
    uint width, height; /* pixels */
    uint count;         /* pixels to trace: the first so many of the list */
    uint sampleIndex;
    float eye[3];
    float spread;    /* radians that a pixel covers; of orthographic cameras: units */
    float corner[3]; /* perspective: direction of the upper left corner; else: offset of its ray */
    uint lightCount;
    float right[3]; /* ... and its change across the picture */
    uint mode;
    float down[3];
    uint bounces;
    float forward[3];
    uint flags;
    float background[3];
    uint launchIndex;
    uint surfacePage; /* first pages of requests */
    uint proxyPage;
    uint emitterCount;
};
SLUICE_SHARED_SIZE(struct PbrtLaunch, 124)

#endif
