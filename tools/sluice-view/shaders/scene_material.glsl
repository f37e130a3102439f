// Materials, written by stage_sets.c.
const uint NO_TEXTURE = 0xFFFFFFFFu;
const uint SLOT_COLOR = 0, SLOT_ROUGHNESS = 1, SLOT_NORMAL = 2, SLOT_OCCLUSION = 3, SLOT_EMISSIVE = 4,
           SLOT_COUNT = 5;
// Flags of slots. SLOT_WRITES_ALONE: the slot writes feedback only if texture sets are off.
const uint SLOT_SECOND_UV = 1, SLOT_WRITES = 2, SLOT_WRITES_ALONE = 4, SLOT_IMAGE_SHIFT = 8;
const uint MATERIAL_MISSING = 1;

struct Slot {
    vec4 turn;
    vec2 offset;
    uint tableIndex; // NO_TEXTURE: none
    uint flags;
};

struct Material {
    vec4 color;
    vec4 emissive; // w: cutoff of alpha; below 0: none
    float metalness, roughness, normalScale, occlusion;
    uint flags, unused1, unused2, unused3;
    Slot slots[SLOT_COUNT];
};

layout(set = 1, binding = 0, std430) readonly buffer Materials
{
    Material materials[];
};
