#include "exr/exr_file.h"

#include "base/log.h"

#include <stdio.h>
#include <string.h>

/* Lists the channel names for messages, as many as fit. */
static void list_channels(const exr_attr_chlist_t *list, char *text, size_t size)
{
    char name[64];
    size_t used = 0;
    text[0] = '\0';
    for (int32_t i = 0; i < list->num_channels && used < size; i++) {
        slc_printable(list->entries[i].name.str, name, sizeof name);
        used += (size_t)snprintf(text + used, size - used, "%s%s", i ? ", " : "", name);
    }
}

static bool has_channel(const exr_attr_chlist_t *list, const char *name)
{
    for (int32_t i = 0; i < list->num_channels; i++)
        if (strcmp(list->entries[i].name.str, name) == 0)
            return true;
    return false;
}

/*
 * Returns the letters of the channels to read: "RGBA" for color, "YA" for gray, NULL for neither.
 * A file may have any number of other channels, such as depth or layers.
 */
static const char *choose_letters(const exr_attr_chlist_t *list)
{
    if (has_channel(list, "R") || has_channel(list, "G") || has_channel(list, "B"))
        return "RGBA";
    if (has_channel(list, "Y"))
        return has_channel(list, "RY") || has_channel(list, "BY") ? NULL : "YA";
    return has_channel(list, "A") ? "A" : NULL;
}

static SluiceResult refuse_names(const struct slc_exr_file *file, const exr_attr_chlist_t *list)
{
    const char *names = file->channel_names;
    if (has_channel(list, "RY") || has_channel(list, "BY"))
        return slc_input_fail(&file->input, SLUICE_ERROR_UNSUPPORTED,
                              "has luminance-chroma channels (%s), which are not read; "
                              "convert the file to R, G, B",
                              names);
    return slc_input_fail(&file->input, SLUICE_ERROR_UNSUPPORTED,
                          "has the channels %s; any of R, G, B, A, or Y with or without A, are "
                          "read, and no layers; write the wanted ones to a file of their own under "
                          "such names",
                          names);
}

static SluiceResult check_channel(struct slc_exr_file *file, const exr_attr_chlist_entry_t *entry)
{
    char name[64];
    slc_printable(entry->name.str, name, sizeof name);
    /* Skipped channels must be checked, too: their data lies between the read ones in each line. */
    if (entry->x_sampling != 1 || entry->y_sampling != 1)
        return slc_input_fail(
            &file->input, SLUICE_ERROR_UNSUPPORTED,
            "channel %s is subsampled %d x %d, which is not read; convert the file "
            "to full resolution",
            name, entry->x_sampling, entry->y_sampling);
    if (entry->pixel_type != EXR_PIXEL_UINT && entry->pixel_type != EXR_PIXEL_HALF &&
        entry->pixel_type != EXR_PIXEL_FLOAT)
        return slc_input_fail(&file->input, SLUICE_ERROR_CORRUPT_DATA,
                              "channel %s has the unknown type %d", name, (int)entry->pixel_type);
    return SLUICE_SUCCESS;
}

static SluiceResult choose_channel(struct slc_exr_file *file, const exr_attr_chlist_entry_t *entry)
{
    uint32_t index = file->channel_count;
    if (index == SLC_EXR_MAX_CHANNELS)
        return slc_input_fail(&file->input, SLUICE_ERROR_CORRUPT_DATA, "has a channel name twice");
    struct slc_exr_channel *channel = &file->channels[index];
    channel->type = entry->pixel_type;
    channel->size = entry->pixel_type == EXR_PIXEL_HALF ? 2 : 4;
    channel->offset = file->texel_size;
    if (channel->size == 4)
        file->widest = EXR_PIXEL_FLOAT;
    file->channel_count++;
    if (entry->name.str[0] == 'Y')
        file->rgba[0] = file->rgba[1] = file->rgba[2] = (int32_t)index;
    else
        file->rgba[strchr("RGBA", entry->name.str[0]) - "RGBA"] = (int32_t)index;
    return SLUICE_SUCCESS;
}

static bool is_one_of(const char *name, const char *letters)
{
    return strlen(name) == 1 && strchr(letters, name[0]);
}

static SluiceResult choose_channels(struct slc_exr_file *file, const exr_attr_chlist_t *list,
                                    const char *letters)
{
    SluiceResult result = SLUICE_SUCCESS;
    for (int32_t i = 0; result == SLUICE_SUCCESS && i < list->num_channels; i++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[i];
        result = check_channel(file, entry);
        if (result == SLUICE_SUCCESS && is_one_of(entry->name.str, letters))
            result = choose_channel(file, entry);
        file->texel_size += entry->pixel_type == EXR_PIXEL_HALF ? 2 : 4;
    }
    return result;
}

static void tell_unread(const struct slc_exr_file *file, const exr_attr_chlist_t *list,
                        const char *letters)
{
    if ((uint32_t)list->num_channels != file->channel_count)
        slc_log(&file->input.log, SLUICE_LOG_INFO, "%s: has the channels %s; only %s are read",
                file->input.path, file->channel_names, letters);
}

SluiceResult slc_exr_read_channels(struct slc_exr_file *file)
{
    const exr_attr_chlist_t *list;
    exr_result_t result = exr_get_channels(file->context, 0, &list);
    if (result != EXR_ERR_SUCCESS || list->num_channels < 1)
        return slc_input_fail(&file->input, SLUICE_ERROR_CORRUPT_DATA, "has no channels");
    if (list->num_channels > SLC_EXR_MAX_FILE_CHANNELS)
        return slc_input_fail(&file->input, SLUICE_ERROR_UNSUPPORTED,
                              "has %d channels; at most %d are read", list->num_channels,
                              SLC_EXR_MAX_FILE_CHANNELS);
    list_channels(list, file->channel_names, sizeof file->channel_names);
    const char *letters = choose_letters(list);
    if (!letters)
        return refuse_names(file, list);
    file->widest = EXR_PIXEL_HALF;
    for (int i = 0; i < 4; i++)
        file->rgba[i] = -1;
    SluiceResult answer = choose_channels(file, list, letters);
    if (answer == SLUICE_SUCCESS)
        tell_unread(file, list, letters);
    return answer;
}
