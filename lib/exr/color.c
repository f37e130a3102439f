#include "exr/exr_file.h"

#include "base/log.h"

static bool find_attribute(const struct slc_exr_file *file, const char *name,
                           exr_attribute_type_t type, const exr_attribute_t **attribute)
{
    return exr_get_attribute_by_name(file->context, 0, name, attribute) == EXR_ERR_SUCCESS &&
           (*attribute)->type == type;
}

/* Tells whether the file has R, G and B as light, not as data. */
static bool has_color(const struct slc_exr_file *file)
{
    for (int c = 0; c < 3; c++) {
        int32_t index = file->rgba[c];
        if (index < 0 || file->channels[index].type == EXR_PIXEL_UINT)
            return false;
    }
    return file->rgba[0] != file->rgba[1];
}

static void tell_luminance(const struct slc_exr_file *file)
{
    const exr_attribute_t *attribute;
    if (find_attribute(file, "whiteLuminance", EXR_ATTR_FLOAT, &attribute))
        slc_log(&file->input.log, SLUICE_LOG_INFO,
                "%s: says that white has %g cd/m2, which is not applied", file->input.path,
                (double)attribute->f);
}

/* Reads the attribute. By the standard, files without the attribute have Rec. 709 primaries. */
static void read_chromaticities(struct slc_exr_file *file)
{
    const exr_attribute_t *attribute;
    file->chromaticities = slc_rec709;
    file->has_chromaticities =
        find_attribute(file, "chromaticities", EXR_ATTR_CHROMATICITIES, &attribute);
    if (!file->has_chromaticities)
        return;
    const exr_attr_chromaticities_t *c = attribute->chromaticities;
    file->chromaticities = (struct slc_chromaticities){
        {(double)c->red_x, (double)c->red_y},
        {(double)c->green_x, (double)c->green_y},
        {(double)c->blue_x, (double)c->blue_y},
        {(double)c->white_x, (double)c->white_y},
    };
}

SluiceResult slc_exr_read_primaries(struct slc_exr_file *file)
{
    const exr_attribute_t *attribute;
    double neutral[2];
    tell_luminance(file);
    read_chromaticities(file);
    if (!has_color(file))
        return SLUICE_SUCCESS; /* gray is the same in all primaries */
    bool is_adopted = find_attribute(file, "adoptedNeutral", EXR_ATTR_V2F, &attribute);
    if (is_adopted) {
        neutral[0] = (double)attribute->v2f->x;
        neutral[1] = (double)attribute->v2f->y;
    }
    if (slc_primaries_to_rec709(&file->chromaticities, is_adopted ? neutral : NULL,
                                file->to_rec709)) {
        file->converts = !slc_matrix_is_identity(file->to_rec709);
        return SLUICE_SUCCESS;
    }
    file->is_foreign = true;
    slc_log(&file->input.log, SLUICE_LOG_WARNING,
            "%s: its chromaticities are no primaries and a white; R, G and B are delivered as "
            "they are",
            file->input.path);
    return SLUICE_SUCCESS;
}
