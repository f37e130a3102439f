/* Structs and numbers that the host code and the shaders of demand-pbrt share. */
#ifndef PBRT_SHARED_H
#define PBRT_SHARED_H

#include "sluice/shared/types.h"

#define PBRT_PAGE_CAPACITY 0x04000000u /* pageCapacity */
#define PBRT_MOST_REQUESTS 0x00020000u /* per launch: boxes, materials and tiles */

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
#define PBRT_BINDING_WORLD 14     /* compute path only */
#define PBRT_BINDING_INSTANCES 15 /* compute path only */
#define PBRT_BINDING_PROBES 16
#define PBRT_OWN_BUFFERS 17
#define PBRT_BINDING_SCENE 17 /* acceleration structure; ray-tracing pipelines only */

#define PBRT_ROW_WIDTH 1024 /* rays of one row of a launch */
#define PBRT_GROUP_SIZE 64  /* threads of the compute path */
#define PBRT_NONE 0xffffffffu
#define PBRT_MAX_BOUNCES 8

/* Hit groups. Instances of the top level name them as offset into the shader table. */
#define PBRT_GROUP_MESH 0
#define PBRT_GROUP_BOX 1

/* A mesh in memory: 32-bit words from `address` on. Offsets are in words. */
struct PbrtMesh {
    uint address[2]; /* device address of the positions, 3 words each */
    uint normals;    /* 0: none */
    uint uvs;        /* 0: none */
    uint indices;
    /* Compute path only. There, indices are in the order of the tree's leaves. */
    uint order; /* the file's number of each triangle */
    uint reserved[2];
};
SLUICE_SHARED_SIZE(struct PbrtMesh, 32)

/* Items of the tree over the world are places, or boxes if this bit is set. */
#define PBRT_ITEM_BOX 0x80000000u

#define PBRT_INSTANCE_OPAQUE 1u /* PbrtInstance.flags */

/* Transform of a place, for the compute path. */
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
#define PBRT_PLACE_TWO_SIDED 8u /* the area light also emits on its back */
#define PBRT_PLACE_LISTED 16u   /* the area light's triangles are PbrtEmitters */

/* A place: a shape in the world. */
struct PbrtPlace {
    uint mesh;
    uint surface; /* surface index of the material */
    uint alpha;   /* surface of the alpha texture, or PBRT_NONE */
    float alphaValue;
    uint flags;
    uint light;
    uint shape;
    uint instance; /* PBRT_NONE: the shape belongs to no object */
};
SLUICE_SHARED_SIZE(struct PbrtPlace, 32)

/* PbrtSurface.kind: values of SluicePbrtMaterialKind, and PBRT_SURFACE_ALPHA. */
#define PBRT_SURFACE_GLOSSY 1u
#define PBRT_SURFACE_MIRROR 2u
#define PBRT_SURFACE_GLASS 3u
#define PBRT_SURFACE_ALPHA 8u

/* A material, or an alpha texture. */
struct PbrtSurface {
    uint realized; /* 0: requested only */
    uint kind;
    uint diffuse; /* the next three are programs: index of the first op, or PBRT_NONE for black */
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
#define PBRT_OP_CHECKER 5u  /* continues with the next op; in odd squares, at `target` */
#define PBRT_OP_JUMP 6u     /* continues at `target` */
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
    float factor; /* multiplies texels */
    float gamma;  /* 0: none */
    float worldToTexture[12];
};
SLUICE_SHARED_SIZE(struct PbrtOp, 128)

struct PbrtLight {
    uint kind;      /* SluicePbrtLightKind */
    uint texture;   /* demand texture of the sky, or PBRT_NONE */
    uint skyLayout; /* SluicePbrtSkyLayout */
    float cosInner;
    float color[3];
    float cosOuter;
    float position[3];
    float density; /* sampled points per area, if the light is a shape */
    float direction[3];
    uint reserved;
    float worldToLight[12];
};
SLUICE_SHARED_SIZE(struct PbrtLight, 112)

/* An emitting triangle in world space. Paths choose one in proportion to its power. */
struct PbrtEmitter {
    float corner[3];
    float below; /* share of the total power in the emitters before this one */
    float side1[3];
    uint light;
    float side2[3];
    uint isTwoSided;
    float outside[3]; /* front side, length 1 */
    uint reserved;
};
SLUICE_SHARED_SIZE(struct PbrtEmitter, 64)

/* Facts about a pixel's first ray, for --debug. */
struct PbrtDebug {
    uint pixel; /* set by the host; PBRT_NONE: none */
    uint kind;  /* 0: not traced, 1: nothing hit, 2: a box, 3: a shape */
    uint place; /* place, or box if `kind` is 2 */
    uint triangle;
    float distance;
    uint missing;
    float diffuse[3];
    uint reserved;
};
SLUICE_SHARED_SIZE(struct PbrtDebug, 40)

/* First picture that the first ray of a pixel samples, for views of programs that show them. */
struct PbrtProbe {
    uint texture; /* PBRT_NONE: none */
    uint launch;  /* last launch of the pixel, if it lacked something then; else 0 */
    float uv[2];
    float dx[2], dy[2]; /* change of uv per pixel, with the LOD bias of the launch */
};
SLUICE_SHARED_SIZE(struct PbrtProbe, 32)

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
#define PBRT_LAUNCH_HEADLIGHT 16u /* the scene has no lights but shapes */
#define PBRT_LAUNCH_DARK_SKY 32u  /* no light comes from infinity: ambient light is white */
#define PBRT_LAUNCH_GRAY 64u      /* boxes and unmade surfaces are gray */
#define PBRT_LAUNCH_QUIET 128u    /* rays request nothing */

/* Constants of the pipeline */
#define PBRT_CONSTANT_PREVIEW 0 /* coarser texels replace missing finer ones; writes probes */

/* Push constants of one launch. */
struct PbrtLaunch {
    uint width, height; /* pixels */
    uint count;         /* pixels to trace: the first `count` in the list */
    uint sampleIndex;
    float eye[3];
    float spread; /* radians per pixel; orthographic cameras: units per pixel */
    float
        corner[3]; /* direction of the upper left corner; orthographic cameras: offset of its ray */
    uint lightCount;
    float right[3]; /* change of `corner` across the picture */
    uint mode;
    float down[3];
    uint bounces;
    float forward[3];
    uint flags;
    float background[3];
    uint launchIndex;
    uint surfacePage; /* first page of surface requests */
    uint proxyPage;
    uint emitterCount;
    float lodBias; /* LOD bias of all pictures */
};
SLUICE_SHARED_SIZE(struct PbrtLaunch, 128)

#endif
