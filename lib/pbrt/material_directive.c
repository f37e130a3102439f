#include "pbrt/parser.h"

#include "pbrt/color_values.h"
#include "pbrt/growth.h"

#include <string.h>

#define MAX_MATERIALS ((size_t)1 << 24)

/* Names of the parameters for a material's fields; NULL: no parameter. */
struct reduction {
    const char *type;
    SluicePbrtMaterialKind kind;
    const char *diffuse, *specular, *transmission;
    float diffuse_default, specular_default, transmission_default;
};

static const struct reduction REDUCTIONS[] = {
    {"matte", SLUICE_PBRT_MATERIAL_DIFFUSE, "Kd", NULL, NULL, 0.5f, 0, 0},
    {"diffuse", SLUICE_PBRT_MATERIAL_DIFFUSE, "reflectance", NULL, NULL, 0.5f, 0, 0},
    {"coateddiffuse", SLUICE_PBRT_MATERIAL_GLOSSY, "reflectance", NULL, NULL, 0.5f, 0.04f, 0},
    {"plastic", SLUICE_PBRT_MATERIAL_GLOSSY, "Kd", "Ks", NULL, 0.25f, 0.25f, 0},
    {"uber", SLUICE_PBRT_MATERIAL_GLOSSY, "Kd", "Ks", "Kt", 0.25f, 0.25f, 0},
    {"substrate", SLUICE_PBRT_MATERIAL_GLOSSY, "Kd", "Ks", NULL, 0.5f, 0.5f, 0},
    {"translucent", SLUICE_PBRT_MATERIAL_DIFFUSE, "Kd", "Ks", NULL, 0.25f, 0.25f, 0},
    {"diffusetransmission", SLUICE_PBRT_MATERIAL_DIFFUSE, "reflectance", NULL, "transmittance",
     0.25f, 0, 0.25f},
    {"disney", SLUICE_PBRT_MATERIAL_GLOSSY, "color", NULL, NULL, 0.5f, 0.04f, 0},
    {"kdsubsurface", SLUICE_PBRT_MATERIAL_DIFFUSE, "Kd", NULL, NULL, 0.5f, 0, 0},
    {"subsurface", SLUICE_PBRT_MATERIAL_DIFFUSE, "reflectance", NULL, NULL, 0.5f, 0, 0},
    {"hair", SLUICE_PBRT_MATERIAL_DIFFUSE, "color", NULL, NULL, 0.2f, 0, 0},
    {"fourier", SLUICE_PBRT_MATERIAL_DIFFUSE, NULL, NULL, NULL, 0.5f, 0, 0},
    {"measured", SLUICE_PBRT_MATERIAL_DIFFUSE, NULL, NULL, NULL, 0.5f, 0, 0},
    {"mirror", SLUICE_PBRT_MATERIAL_MIRROR, NULL, "Kr", NULL, 0, 0.9f, 0},
    {"metal", SLUICE_PBRT_MATERIAL_MIRROR, NULL, NULL, NULL, 0, 0, 0},
    {"conductor", SLUICE_PBRT_MATERIAL_MIRROR, NULL, "reflectance", NULL, 0, 0, 0},
    {"coatedconductor", SLUICE_PBRT_MATERIAL_MIRROR, NULL, "reflectance", NULL, 0, 0, 0},
    {"glass", SLUICE_PBRT_MATERIAL_GLASS, NULL, "Kr", "Kt", 0, 1, 1},
    {"dielectric", SLUICE_PBRT_MATERIAL_GLASS, NULL, NULL, NULL, 0, 1, 1},
    {"thindielectric", SLUICE_PBRT_MATERIAL_GLASS, NULL, NULL, NULL, 0, 1, 1},
    {"none", SLUICE_PBRT_MATERIAL_NONE, NULL, NULL, NULL, 0, 0, 0},
    {"interface", SLUICE_PBRT_MATERIAL_NONE, NULL, NULL, NULL, 0, 0, 0},
    {"", SLUICE_PBRT_MATERIAL_NONE, NULL, NULL, NULL, 0, 0, 0},
    {"mix", SLUICE_PBRT_MATERIAL_MIX, NULL, NULL, NULL, 0, 0, 0},
};

static const struct reduction UNKNOWN = {
    NULL, SLUICE_PBRT_MATERIAL_DIFFUSE, "Kd", NULL, NULL, 0.5f, 0, 0};

static const struct reduction *find_reduction(const char *type)
{
    for (size_t i = 0; i < sizeof REDUCTIONS / sizeof *REDUCTIONS; i++)
        if (strcmp(REDUCTIONS[i].type, type) == 0)
            return &REDUCTIONS[i];
    return &UNKNOWN;
}

static void set_value(SluicePbrtValue *value, float to)
{
    value->value[0] = value->value[1] = value->value[2] = to;
    value->texture = SLUICE_PBRT_NONE;
}

/* Table of materials */

static bool grow_table(struct slc_pbrt_parser *parser)
{
    SluicePbrtScene *scene = parser->scene;
    size_t size = parser->material_table_size ? 2 * parser->material_table_size : 64;
    uint32_t *table = slc_alloc(&scene->allocator, size, sizeof *table);
    if (!table)
        return slc_pbrt_out_of_memory(parser);
    memset(table, 0xFF, size * sizeof *table);
    slc_free(&scene->allocator, parser->material_table, parser->material_table_size, sizeof *table);
    parser->material_table = table;
    parser->material_table_size = size;
    for (size_t i = 0; i < scene->material_count; i++) {
        struct slc_pbrt_material_entry *entry = &scene->materials[i];
        size_t place =
            slc_pbrt_hash(entry, offsetof(struct slc_pbrt_material_entry, next)) & (size - 1);
        entry->next = table[place];
        table[place] = (uint32_t)i;
    }
    return true;
}

static bool append_material(struct slc_pbrt_parser *parser,
                            const struct slc_pbrt_material_entry *entry)
{
    SluicePbrtScene *scene = parser->scene;
    if (scene->material_count >= MAX_MATERIALS) {
        struct slc_pbrt_place place = slc_pbrt_token_place(&parser->token);
        return slc_pbrt_stop(parser, SLUICE_ERROR_LIMIT_EXCEEDED, &place, "2^24 materials");
    }
    if (!slc_pbrt_grow(&scene->allocator, &scene->materials, &scene->material_capacity,
                       scene->material_count + 1, sizeof *scene->materials))
        return slc_pbrt_out_of_memory(parser);
    memcpy(&scene->materials[scene->material_count++], entry, sizeof *entry);
    return true;
}

/* Adds a material. Padding of the struct is 0, so that equal materials have equal bytes. */
static bool add_material(struct slc_pbrt_parser *parser, struct slc_pbrt_material_entry *entry,
                         uint32_t *index)
{
    SluicePbrtScene *scene = parser->scene;
    size_t size = offsetof(struct slc_pbrt_material_entry, next);
    if (scene->material_count >= parser->material_table_size && !grow_table(parser))
        return false;
    size_t place = slc_pbrt_hash(entry, size) & (parser->material_table_size - 1);
    for (uint32_t i = parser->material_table[place]; i != SLUICE_PBRT_NONE;
         i = scene->materials[i].next)
        if (memcmp(&scene->materials[i], entry, size) == 0) {
            *index = i;
            return true;
        }
    entry->next = parser->material_table[place];
    if (!append_material(parser, entry))
        return false;
    *index = parser->material_table[place] = (uint32_t)scene->material_count - 1;
    return true;
}

static void init_material(struct slc_pbrt_material_entry *entry)
{
    memset(entry, 0, sizeof *entry);
    SluicePbrtMaterial *material = &entry->material;
    material->structSize = sizeof *material;
    material->materials[0] = material->materials[1] = SLUICE_PBRT_NONE;
    set_value(&material->diffuse, 0);
    set_value(&material->specular, 0);
    set_value(&material->transmission, 0);
    set_value(&material->opacity, 1);
    set_value(&material->roughness, 0);
    set_value(&material->amount, 0.5f);
    material->eta = 1.5f;
    entry->next = SLUICE_PBRT_NONE;
}

bool slc_pbrt_add_default_material(struct slc_pbrt_parser *parser)
{
    struct slc_pbrt_material_entry entry;
    init_material(&entry);
    set_value(&entry.material.diffuse, 0.5f);
    if (!slc_pbrt_intern(parser, "matte", &entry.type) ||
        !add_material(parser, &entry, &parser->default_material))
        return false;
    parser->state.material = parser->default_material;
    return true;
}

/* Finds a named material, or makes a placeholder for a later definition. */
static bool find_named(struct slc_pbrt_parser *parser, uint32_t name, uint32_t instead,
                       const struct slc_pbrt_place *place, uint32_t *index)
{
    SluicePbrtScene *scene = parser->scene;
    if (!slc_pbrt_look_up(parser, name, SLC_PBRT_NAMED_MATERIAL, index))
        return false;
    if (*index != SLUICE_PBRT_NONE)
        return true;
    struct slc_pbrt_forward *last =
        parser->forward_count ? &parser->forwards[parser->forward_count - 1] : NULL;
    if (last && last->name == name && (last->instead == instead || last->material == instead)) {
        *index = last->material;
        return true;
    }
    struct slc_pbrt_material_entry entry;
    init_material(&entry);
    entry.material.structSize = 0; /* marks a placeholder */
    entry.type = name;
    if (!slc_pbrt_grow(&scene->allocator, &parser->forwards, &parser->forward_capacity,
                       parser->forward_count + 1, sizeof *parser->forwards))
        return slc_pbrt_out_of_memory(parser);
    if (!append_material(parser, &entry))
        return false;
    *index = (uint32_t)scene->material_count - 1;
    parser->forwards[parser->forward_count++] =
        (struct slc_pbrt_forward){*index, instead, name, *place};
    return true;
}

/* Fields from parameters */

static bool apply(struct slc_pbrt_parser *parser, const char *name, bool is_float,
                  SluicePbrtValue *value, bool *changed)
{
    bool found;
    if (!slc_pbrt_read_value(parser, name, is_float, value, &found))
        return false;
    *changed |= found;
    return true;
}

/* Computes a metal's reflectance at normal incidence from its index of refraction. */
static bool apply_metal(struct slc_pbrt_parser *parser, SluicePbrtValue *specular, bool *changed)
{
    float eta[3], k[3];
    const struct slc_pbrt_parameter *named =
        slc_pbrt_find(&parser->parameters, SLC_PBRT_TYPES(SLC_PBRT_SPECTRUM), "eta");
    if (!named)
        named =
            slc_pbrt_find(&parser->parameters, SLC_PBRT_TYPES(SLC_PBRT_SPECTRUM), "conductor.eta");
    bool has_eta = slc_pbrt_read_color(parser, "eta", eta, false) ||
                   slc_pbrt_read_color(parser, "conductor.eta", eta, false);
    if (!has_eta)
        return parser->result == SLUICE_SUCCESS;
    *changed = true;
    specular->texture = SLUICE_PBRT_NONE;
    if (named && named->has_strings) { /* read as a reflectance */
        memcpy(specular->value, eta, sizeof eta);
        return true;
    }
    if (!slc_pbrt_read_color(parser, "k", k, false) &&
        !slc_pbrt_read_color(parser, "conductor.k", k, false))
        return parser->result == SLUICE_SUCCESS;
    for (int i = 0; i < 3; i++) {
        float least = (eta[i] - 1) * (eta[i] - 1) + k[i] * k[i];
        float most = (eta[i] + 1) * (eta[i] + 1) + k[i] * k[i];
        specular->value[i] = most > 0 ? least / most : 0;
    }
    return true;
}

static bool apply_parameters(struct slc_pbrt_parser *parser, const struct reduction *reduction,
                             SluicePbrtMaterial *material, bool *changed)
{
    bool is_metal = material->kind == SLUICE_PBRT_MATERIAL_MIRROR;
    if (is_metal && !apply_metal(parser, &material->specular, changed))
        return false;
    if ((reduction->diffuse &&
         !apply(parser, reduction->diffuse, false, &material->diffuse, changed)) ||
        (reduction->specular &&
         !apply(parser, reduction->specular, false, &material->specular, changed)) ||
        (reduction->transmission &&
         !apply(parser, reduction->transmission, false, &material->transmission, changed)))
        return false;
    if (!reduction->type && !apply(parser, "reflectance", false, &material->diffuse, changed))
        return false;
    if (reduction->type && strcmp(reduction->type, "uber") == 0 &&
        !apply(parser, "opacity", false, &material->opacity, changed))
        return false;
    if (material->kind == SLUICE_PBRT_MATERIAL_NONE || material->kind == SLUICE_PBRT_MATERIAL_MIX)
        return true;
    float eta = slc_pbrt_get_float(&parser->parameters, "eta",
                                   slc_pbrt_get_float(&parser->parameters, "index", 0));
    if (!is_metal && eta > 0) {
        material->eta = eta;
        *changed = true;
    }
    return apply(parser, "roughness", true, &material->roughness, changed);
}

static bool read_part(struct slc_pbrt_parser *parser, const char *text, uint32_t *part,
                      const struct slc_pbrt_place *place)
{
    uint32_t name;
    *part = parser->default_material;
    if (text)
        return slc_pbrt_intern(parser, text, &name) &&
               find_named(parser, name, parser->default_material, place, part);
    slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                 "a mixture without two materials: the default is taken");
    return true;
}

/* Reads a mixture. `amount` weighs the first material in pbrt-v3, the second in pbrt-v4. */
static bool read_mixture(struct slc_pbrt_parser *parser, SluicePbrtMaterial *material,
                         const struct slc_pbrt_place *place)
{
    const struct slc_pbrt_parameters *parameters = &parser->parameters;
    const struct slc_pbrt_parameter *p =
        slc_pbrt_find(parameters, SLC_PBRT_TYPES(SLC_PBRT_STRING), "materials");
    const char *parts[2] = {slc_pbrt_get_string(parameters, "namedmaterial2"),
                            slc_pbrt_get_string(parameters, "namedmaterial1")};
    bool found;
    for (size_t i = 0; p && i < 2; i++)
        parts[i] =
            i < p->count ? parameters->chars + slc_pbrt_cells(parameters, p)[i].string : NULL;
    return read_part(parser, parts[0], &material->materials[0], place) &&
           read_part(parser, parts[1], &material->materials[1], place) &&
           slc_pbrt_read_value(parser, "amount", p != NULL, &material->amount, &found);
}

/* Makes a material of a type from the directive's parameters. */
static bool make_material(struct slc_pbrt_parser *parser, uint32_t type,
                          const struct slc_pbrt_place *place, uint32_t *index)
{
    struct slc_pbrt_material_entry entry;
    const char *text = slc_pbrt_name(&parser->scene->names, type);
    const struct reduction *reduction = find_reduction(text);
    bool changed = false;
    init_material(&entry);
    entry.type = type;
    entry.material.kind = reduction->kind;
    set_value(&entry.material.diffuse, reduction->diffuse_default);
    set_value(&entry.material.specular, reduction->specular_default);
    set_value(&entry.material.transmission, reduction->transmission_default);
    if (reduction->kind == SLUICE_PBRT_MATERIAL_MIRROR && reduction->specular_default == 0)
        slc_pbrt_metal_rgb("Cu", entry.material.specular.value);
    if (reduction == &UNKNOWN)
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                     "materials of the type \"%s\" are not known: matte is taken", text);
    if (reduction->kind == SLUICE_PBRT_MATERIAL_MIX &&
        !read_mixture(parser, &entry.material, place))
        return false;
    return apply_parameters(parser, reduction, &entry.material, &changed) &&
           add_material(parser, &entry, index);
}

bool slc_pbrt_override_material(struct slc_pbrt_parser *parser, uint32_t base, uint32_t *material)
{
    SluicePbrtScene *scene = parser->scene;
    struct slc_pbrt_material_entry entry;
    bool changed = false;
    *material = base;
    memcpy(&entry, &scene->materials[base], sizeof entry);
    const struct reduction *reduction = find_reduction(slc_pbrt_name(&scene->names, entry.type));
    if (entry.material.structSize == 0 || entry.material.kind == SLUICE_PBRT_MATERIAL_MIX ||
        entry.material.kind == SLUICE_PBRT_MATERIAL_NONE)
        return true;
    if (!apply_parameters(parser, reduction, &entry.material, &changed))
        return false;
    return !changed || add_material(parser, &entry, material);
}

/* Directives */

bool slc_pbrt_material(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    uint32_t type;
    bool found;
    if (!slc_pbrt_read_name(parser, "type of the material", &type, &found) ||
        !slc_pbrt_read_parameters_for(parser, SLC_PBRT_TARGET_MATERIAL))
        return false;
    return !found || make_material(parser, type, place, &parser->state.material);
}

bool slc_pbrt_make_named_material(struct slc_pbrt_parser *parser,
                                  const struct slc_pbrt_place *place)
{
    uint32_t name, type, index;
    bool found;
    if (!slc_pbrt_read_name(parser, "name of the material", &name, &found) ||
        !slc_pbrt_read_parameters_for(parser, SLC_PBRT_TARGET_MATERIAL))
        return false;
    if (!found)
        return true;
    const char *text = slc_pbrt_get_string(&parser->parameters, "type");
    if (!text) {
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                     "the material has no \"string type\": matte is taken");
        text = "matte";
    }
    return slc_pbrt_intern(parser, text, &type) && make_material(parser, type, place, &index) &&
           slc_pbrt_define(parser, name, SLC_PBRT_NAMED_MATERIAL, index);
}

bool slc_pbrt_named_material(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    uint32_t name;
    bool found;
    if (!slc_pbrt_read_name(parser, "name of the material", &name, &found))
        return false;
    return !found ||
           find_named(parser, name, parser->state.material, place, &parser->state.material);
}
